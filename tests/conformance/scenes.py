"""The impacts of conformance/impacts.json, as data: bodies, contacts, and what each case shows.

A case is made of bodies. M, J and the velocities before follow from them here, as doubles; the doubles are then the case.
"""

from math import hypot

from mpmath import cos, mp, mpf, sin

CASES = []

LUBARDA = 'V. A. Lubarda (2009), Bounds on the coefficients of restitution, doi:10.1115/1.3172198, '
KANE = 'T. R. Kane, D. A. Levinson (1985), Dynamics: Theory and Applications, the double pendulum that strikes a floor'
WANG = 'Y. Wang, M. T. Mason (1992), Two-dimensional rigid-body collisions with friction, Journal of Applied Mechanics 59'
KELLER = 'J. B. Keller (1986), Impact with friction, Journal of Applied Mechanics 53'
STRONGE = 'W. J. Stronge (1990), Rigid body collisions with friction, doi:10.1098/rspa.1990.0125'
OWN = 'made for this test'


def body(mass, inertia, centre, velocity=(0, 0), rate=0):
    """A free body; in space the inertia and the rate have three numbers."""
    return {'mass_kg': mass, 'inertia_com_kg_m2': inertia, 'centre_m': list(centre), 'velocity_m_s': list(velocity),
            'rate_rad_s': list(rate) if isinstance(rate, (list, tuple)) else rate}


def contact(friction, coefficient, point=(0, 0), normal=(0, 1), first=1, second=0):
    return {'body': first, 'other_body': second, 'point_m': list(point), 'normal': list(normal), 'friction': friction,
            'coefficient': coefficient}


def tangents(normal):
    """t in a plane, which points to the right where n points up; x and y in space, where n is z."""
    return [[normal[1], -normal[0]]] if len(normal) == 2 else [[1, 0, 0], [0, 1, 0]]


def directions(one):
    length = hypot(*one['normal'])
    normal = [x / length for x in one['normal']]
    return [*tangents(normal), normal]


def point_rows(centre, point, lines):
    """Rows of the Jacobian of a point of a free body along `lines`."""
    r = [p - c + 0.0 for p, c in zip(point, centre)]
    if len(r) == 2:
        return [[*line, r[0] * line[1] - r[1] * line[0]] for line in lines]
    return [[*line, r[1] * line[2] - r[2] * line[1], r[2] * line[0] - r[0] * line[2], r[0] * line[1] - r[1] * line[0]]
            for line in lines]


def add(name, family, shows, source, **rest):
    CASES.append({'name': name, 'family': family, 'shows': shows, 'source': source, **rest})


def add_bodies(name, family, shows, source, bodies, contacts, **rest):
    """Free bodies in a plane or in space."""
    d = len(bodies[0]['centre_m'])
    n = 3 if d == 2 else 6
    axes = 'xy' if d == 2 else 'xyz'
    size = n * len(bodies)
    mass = [[0] * size for _ in range(size)]
    names, before = [], []
    for i, one in enumerate(bodies):
        for k in range(d):
            mass[n * i + k][n * i + k] = one['mass_kg']
        inertia = [one['inertia_com_kg_m2']] if d == 2 else one['inertia_com_kg_m2']
        for k, moment in enumerate(inertia):
            mass[n * i + d + k][n * i + d + k] = moment
        names += [f'body_{i + 1}.{axis}' for axis in axes]
        names += [f'body_{i + 1}.rate'] if d == 2 else [f'body_{i + 1}.rate_{axis}' for axis in axes]
        before += [*one['velocity_m_s'], *([one['rate_rad_s']] if d == 2 else one['rate_rad_s'])]
    jacobian = []
    for one in contacts:
        rows = [[0] * size for _ in range(d)]
        for number, side in ((one['body'], 1), (one['other_body'], -1)):
            if number == 0:
                continue
            found = point_rows(bodies[number - 1]['centre_m'], one['point_m'], directions(one))
            for row, entries in zip(rows, found):
                row[n * (number - 1):n * number] = [side * x for x in entries]
        jacobian += rows
    add(name, family, shows, source, bodies=bodies, contacts=contacts, coordinates=names, mass_matrix=mass,
        jacobian=jacobian, velocity_before=before, **rest)


def single(name, family, shows, source, mass, inertia, offset, velocity, rate, friction, coefficient, **rest):
    """One free body in a plane whose contact point is `offset` from its centre of mass; the point is the origin."""
    centre = [-offset[0], -offset[1]]
    add_bodies(name, family, shows, source, [body(mass, inertia, centre, velocity, rate)],
               [contact(friction, coefficient)], **rest)


def pendulum(name, shows, source, a, b, friction, coefficient, family='pendulum'):
    """A uniform rod from the pin O = (0, 0) to (a, -b), with 1 kg m^2 about the pin and -1 rad/s."""
    rod = {**body(3 / (a * a + b * b), 0.25, [a / 2, -b / 2], [-b / 2, -a / 2], -1), 'pin_m': [0, 0]}
    add(name, family, shows, source, bodies=[rod], contacts=[contact(friction, coefficient, [a, -b])],
        coordinates=['body_1.rate'], mass_matrix=[[1]], jacobian=[[b], [a]], velocity_before=[-1])


def chain(name, shows, source, angles, rates, friction, coefficient, length=1.0, mass=1.0):
    """Equal uniform links that hang from a pin; angles are absolute, from the downward vertical, and the tip strikes."""
    with mp.workdps(50):
        theta = [mpf(x) for x in angles]
        n = len(theta)
        com, inertia = mpf(length) / 2, mpf(mass) * mpf(length)**2 / 12

        def reach(k, i):  # How the centre of mass of link k follows link i.
            return mpf(length) if i < k else com if i == k else mpf(0)
        matrix = [[float(sum(mass * reach(k, i) * reach(k, j) for k in range(n)) * cos(theta[i] - theta[j])
                         + (inertia if i == j else 0)) for j in range(n)] for i in range(n)]
        along = [[float(length * cos(t)) for t in theta], [float(length * sin(t)) for t in theta]]
        bodies, pin, velocity = [], [mpf(0), mpf(0)], [mpf(0), mpf(0)]
        for t, rate in zip(theta, rates):
            arm, turn = (sin(t), -cos(t)), (cos(t), sin(t))
            one = body(mass, float(inertia), [float(p + com * x) for p, x in zip(pin, arm)],
                       [float(v + com * rate * x) for v, x in zip(velocity, turn)], rate)
            bodies.append({**one, 'pin_m': [float(p) for p in pin]})
            pin = [p + length * x for p, x in zip(pin, arm)]
            velocity = [v + length * rate * x for v, x in zip(velocity, turn)]
        tip = [float(p) for p in pin]
    add(name, 'linkage', shows, source, bodies=bodies, contacts=[contact(friction, coefficient, tip, first=n)],
        coordinates=[f'body_{i + 1}.rate' for i in range(n)], mass_matrix=matrix, jacobian=along, velocity_before=rates)


def mechanism(name, family, shows, source, mass, jacobian, rates, contacts, **rest):
    """A mechanism that its coordinates alone describe."""
    add(name, family, shows, source, contacts=[{'friction': f, 'coefficient': e} for f, e in contacts],
        coordinates=[f'rate_{i + 1}' for i in range(len(rates))], mass_matrix=mass, jacobian=jacobian,
        velocity_before=rates, **rest)


BALL = (1, 0.004, (0, -0.1))  # Mass, inertia of a solid sphere of 0.1 m, contact seen from its centre.
DISK = (1, 0.005, (0, -0.1))
ROD = 1 / 12  # About the centre of mass, of a uniform rod of 1 kg and 1 m.
TILTED = (1, ROD, (-0.3, -0.4))  # A rod whose lower end lies to the left of its centre: Wtn < 0.
STEEP = (1, ROD, (0.2, -0.45))
FLAT = (1, ROD, (0.4, -0.3))


def frictionless():
    family = 'frictionless'
    ball = 'A ball drops straight: without friction all laws agree, and the rebound is %s of the approach.'
    for word, e in (('elastic', 1), ('three-quarters', 0.75), ('plastic', 0)):
        single(f'ball-drops-{word}', family, ball % e, 'github.com/newton-physics/newton issue 3588: a bouncing ball', *BALL,
               (0, -1), 0, 0, e)
    single('ball-drops-slowly', family, 'Restitution has no threshold of speed: 0.01 m/s rebounds like 1 m/s.',
           'engines ignore restitution below a threshold, 1 m/s in Box2D 2.4 by default', *BALL, (0, -0.01), 0, 0, 0.75)
    single('ball-leaves', family, 'A contact that separates already is left alone.', OWN, *BALL, (0.5, 0.25), 2, 0.3, 0.5)
    single('spinning-ball-without-friction', family, 'Neither slip nor spin changes without friction.', OWN, *BALL, (1, -1),
           20, 0, 0.5)
    single('rod-end-without-friction', family, 'A rod strikes with one end and starts to turn.', STRONGE, *TILTED, (0, -1), 0,
           0, 0.5)
    single('rod-end-elastic', family, 'The same with slip and a coefficient of 1: the energy stays.', STRONGE, *TILTED, (0.5, -1), 1, 0, 1)


def sliding():
    family = 'sliding'
    single('disk-slides', family, 'Slip outlasts the impact: the friction impulse is mu times the normal one.', WANG, *DISK,
           (5, -1), 0, 0.125, 0.5)
    single('sphere-slides', family, 'The same for a sphere, for which all laws agree.', WANG, *BALL, (-4, -1), 0, 0.2, 0.9)
    single('sphere-with-back-spin', family, 'Spin makes the contact slide forwards although the centre moves back.', OWN,
           *BALL, (-1, -2), 80, 0.2, 0.75)
    single('sphere-with-top-spin', family, 'Friction drives the ball on: it leaves faster along the floor than it came.', OWN,
           *BALL, (1, -2), -80, 0.2, 0.75)
    for name, velocity, e in (('left', (-3, -1), 0.5), ('right', (3, -1), 0.5), ('elastic', (3, -1), 1), ('plastic', (3, -1), 0)):
        single(f'rod-slides-{name}', family, 'A rod slides throughout: slip and normal velocity are coupled.', WANG, *TILTED,
               velocity, 0, 0.2, e)
    single('rod-slides-fast-rotation', family, 'The slip comes from the rotation alone, and turns round in compression.', WANG, *FLAT, (0, -2), -6, 0.1, 0.6)


def sticking():
    family = 'stick'
    single('sphere-sticks-in-compression', family, 'Slip stops early; the ball then rolls on the spot.', WANG, *BALL, (0.5, -1), 0,
           0.5, 0.5)
    single('sphere-sticks-in-restitution', family, 'Slip stops after the end of compression.', WANG, *BALL, (1, -1), 0, 0.2, 0.8)
    single('sphere-without-slip', family, 'No slip before, none after: friction has nothing to do.', WANG, 1, 0.00625,
           (0, -0.125), (1, -1), -8, 0.5, 0.5)
    single('rod-starts-in-stick', family, 'Slip is 0 before the impact, but friction is needed to keep it so.', WANG, *STEEP,
           (-0.45, -1), 1, 0.9, 0.5)
    single('rod-sticks-in-compression', family, 'Slip stops in compression and does not come back.', WANG, *STEEP, (-0.5, -1),
           0, 0.5, 0.5)
    single('rod-sticks-in-restitution', family, 'Slip stops in restitution.', WANG, 1, 0.5, (0.8, -0.9), (-1.5, -1), 0, 0.8, 0.8)
    single('rod-just-sticks', family, 'Friction lies 1 % above what holds the contact.', WANG, *FLAT, (-0.5, -1), 0, 0.7, 0.7)
    single('rod-all-but-sticks', family, 'Friction lies 0.3 % below what would hold the contact: it slides again.', WANG, *FLAT,
           (-0.5, -1), 0, 0.69, 0.7)
    single('rod-sticks-elastic', family, 'At a coefficient of 1 the laws keep different amounts of the energy.', STRONGE, *STEEP,
           (-0.5, -1), 0, 0.5, 1)


def reversal():
    family = 'reversal'
    for name, offset, speed, friction, e in (
            ('rod-reverses-in-compression', (0.35, -0.35), -0.2, 0.3, 0.5),
            ('rod-reverses-in-restitution', (0.35, -0.35), -0.9, 0.3, 0.9),
            ('rod-reverses-elastic', (0.35, -0.35), -0.2, 0.3, 1),
            ('rod-reverses-plastic', (0.35, -0.35), -0.2, 0.3, 0),
            ('rod-reverses-mirrored', (-0.35, -0.35), 0.2, 0.3, 0.5),
            ('rod-starts-to-slip', (0.35, -0.35), 0, 0.3, 0.5),
            ('flat-rod-reverses', (0.45, -0.2), -0.3, 0.4, 0.7)):
        shows = ('Slip stops and goes on the other way: one impulse for the whole impact cannot say that.' if speed else
                 'A contact without slip is set slipping, because friction is too weak for the coupling.')
        single(name, family, shows, WANG, 1, ROD, offset, (speed, -1), 0, friction, e)
    single('flat-rod-reverses-by-rotation', family, 'The same with the rotation before the impact alone.', STRONGE, 1, ROD,
           (0.45, -0.2), (0, 0), -3, 0.25, 0.6)


def jamming():
    family = 'jamming'
    jam = 'Friction drives the rod into the floor: its normal speed rises at first (Painleve).'
    single('rod-jams', family, jam, WANG, *STEEP, (0.5, -1), 0, 1.6, 0.5)
    single('rod-jams-fast', family, jam, WANG, *STEEP, (3, -0.5), 0, 1.6, 0.5)
    single('rod-jams-elastic', family, jam, WANG, *STEEP, (0.5, -1), 0, 1.8, 1)
    single('rod-jams-mirrored', family, jam, WANG, 1, ROD, (-0.2, -0.45), (-0.5, -1), 0, 1.6, 0.5)
    single('rod-jams-without-approach', family, 'The approach is a millionth of the slip, yet the impact is hard: jamming makes it.',
           WANG, *STEEP, (1, -1e-6), 0, 1.6, 0.5)
    single('rod-nearly-jams', family, 'Friction lies 1 % below what would drive the rod into the floor.', WANG, *STEEP, (0.5, -1),
           0, 1.36, 0.5)


def extreme_directions():
    family = 'directions'
    single('sphere-grazes', family, 'A grazing impact: slip is 10^5 times the approach.', OWN, *BALL, (100, -0.001), 0, 0.3, 0.8)
    single('rod-grazes', family, 'A grazing impact in which slip couples into the normal velocity.', OWN, *TILTED, (50, -0.01), 0,
           0.2, 0.8)
    single('sphere-nearly-vertical', family, 'A slip of 10^-6 m/s stops at once.', OWN, *BALL, (1e-6, -1), 0, 0.3, 0.8)
    single('rod-nearly-vertical-stick', family, 'A slip of 10^-9 m/s stops at once, and friction holds.', OWN, *STEEP, (-1e-9, -1),
           0, 0.9, 0.5)
    single('rod-nearly-vertical-reversal', family, 'A slip of 10^-9 m/s turns round at once.', OWN, 1, ROD, (0.35, -0.35),
           (-1e-9, -1), 0, 0.3, 0.5)
    single('rod-upright', family, 'A rod that stands on its end: nothing couples slip to the normal velocity.', OWN, 1, ROD,
           (0, -0.5), (1, -1), 0, 0.3, 0.5)
    single('rod-nearly-flat', family, 'The contact is 1 mm below the centre of mass.', LUBARDA + 'section 9: nearly vertical impact',
           1, ROD, (0.5, -0.001), (0.1, -1), 0, 0.4, 0.8)


def pendulums():
    paper = LUBARDA
    pendulum('pendulum-1-without-friction', 'Without friction all laws agree.', paper + 'Eq. (14)', 0.3, 1, 0, 0.8)
    pendulum('pendulum-2-paper', 'Slip reverses at the end of compression; the laws give 1, 1/2 and the root of 1/2.',
             paper + 'section 8.1', 0.3, 1, 0.1, 1)
    pendulum('pendulum-3-nearly-vertical', 'The impact is nearly vertical.', paper + 'section 9', 4, 1, 0.4, 0.8)
    pendulum('pendulum-4-locked', 'Friction locks the pendulum, whatever the coefficient.', paper + 'section 6.1', 0.3, 1, 0.5, 0.8)
    pendulum('pendulum-5-all-but-locked', 'Friction all but locks it.', paper + 'Eqs. (29), (30)', 0.3, 1, 0.29, 1)
    pendulum('pendulum-plastic', 'It stays in contact at the end of compression.', paper + 'Eq. (8)', 0.3, 1, 0.1, 0)
    pendulum('pendulum-above-the-surface', 'The pin lies below the contact: friction changes its sign, nothing else.',
             paper + 'Eq. (1)', 0.3, -1, 0.1, 0.9)
    pendulum('pendulum-locks-exactly', 'mu b = a: friction just locks it.', paper + 'section 6.1', 0.5, 1, 0.5, 0.8)
    pendulum('pendulum-figure-4', 'A point of figure 4: a = b, mu = 1/2.', paper + 'Fig. 4', 1, 1, 0.5, 1)


def linkages():
    angles, rates = (0.3490658503988659, 0.5235987755982989), [-0.1, -0.2]
    for friction, e in ((0, 0.5), (0.1, 0.5), (0.5, 0.5), (0.7, 0.5), (0.5, 1), (0.7, 1)):
        paradox = friction >= 0.5
        chain(f'double-pendulum-mu-{friction}-e-{e}', "Kane and Levinson's paradox: Newton's law with friction creates energy."
              if paradox else "Kane and Levinson's double pendulum with little friction.", KANE, angles, rates, friction, e)
    chain('triple-pendulum', 'Three links: inertia couples every joint to the tip.', OWN, (0.3, 0.7, 1.1), [-0.4, -0.3, -0.6], 0.3,
          0.6)
    chain('chain-of-four', 'Four links that strike while the tip slides.', OWN, (0.2, -0.3, 0.6, 1.2), [0.5, -0.4, 0.1, -1.5], 0.2,
          0.8)


def pairs():
    family = 'pair'

    def pair(name, shows, source, first, second, friction, e, **rest):
        bodies = [body(m, i, [-o[0], -o[1]], v, w) for m, i, o, v, w in (first, second)]
        add_bodies(name, rest.pop('family', family), shows, source, bodies, [contact(friction, e, second=2)], **rest)

    ball, under = (1, 0.004, (0, -0.1)), (1, 0.004, (0, 0.1))
    pair('equal-balls-head-on', 'The balls exchange a share of their speeds.', OWN, (*ball, (0, -1), 0), (*under, (0, 0.5), 0), 0,
         0.75)
    pair('equal-balls-mirrored', 'Two balls that mirror each other must leave as mirror images.',
         'github.com/dimforge/rapier issue 668: symmetric scenes', (*ball, (0, -1), 3), (*under, (0, 1), -3), 0.3, 0.5,
         symmetries=[[4, -5, -6, 1, -2, -3]])
    pair('ball-on-spinning-ball', 'One ball spins, and friction makes gears of the two.', 'github.com/ekiefl/pooltool issue 153',
         (*ball, (0, -1), 0), (*under, (0, 0), 50), 0.06, 0.95)
    pair('billiard-cut', 'A cut shot: the object ball is thrown off its line by friction.', 'github.com/ekiefl/pooltool issue 153',
         (0.17, 0.000055, (0, -0.028575), (1.5, -1), 0), (0.17, 0.000055, (0, 0.028575), (0, 0), 0), 0.06, 0.95)
    pair('two-rods', 'Both bodies turn; slip stops in compression.', STRONGE, (1, 0.1, (-0.3, 0), (1, -2), 0), (2, 0.1, (0.2, 0.3), (0, 0), 0),
         0.4, 0.5)
    pair('two-rods-reverse', 'Slip between two rods turns round.', STRONGE, (1, ROD, (0.35, -0.35), (-0.1, -1), 0),
         (1, ROD, (-0.2, 0.4), (0, 0), 0), 0.1, 0.7)
    pair('rod-on-ball', 'A rod strikes a ball off its centre line.', OWN, (2, 0.15, (0.35, -0.25), (0, -1), 0.5),
         (0.5, 0.001, (0, 0.07), (0, 0), 0), 0.2, 0.8)
    heavy = 'A mass ratio of 10^%d: what the light body does must not drown in the rounding of the heavy one.'
    for exponent in (3, 6, 9):
        mass = 10.0 ** exponent
        pair(f'heavy-ball-on-light-1e{exponent}', heavy % exponent, 'mass ratios stop iterative solvers early: Catto (2014), '
             'Understanding constraints', (mass, 0.004 * mass, (0, -0.1), (0, -1), 0), (*under, (0, 0), 20), 0.3, 0.9,
             family='mass-ratio')
    for exponent in (3, 6):
        mass = 10.0 ** exponent
        pair(f'light-rod-on-heavy-1e{exponent}', heavy % exponent, OWN, (1, ROD, (0.35, -0.35), (-0.2, -1), 0),
             (mass, 0.1 * mass, (0.3, 0.4), (0, 0), 0), 0.3, 0.5, family='mass-ratio')


def space():
    family = 'space'

    def solid(name, shows, source, mass, inertia, offset, velocity, rate, friction, e, **rest):
        add_bodies(name, rest.pop('family', family), shows, source,
                   [body(mass, list(inertia), [-x for x in offset], velocity, list(rate))],
                   [contact(friction, e, (0, 0, 0), (0, 0, 1))], **rest)

    ball = (1, (0.004, 0.004, 0.004), (0, 0, -0.1))
    box = (2, (0.05, 0.08, 0.06), (0.15, 0.1, -0.2))
    turning = 'Slip turns while it slows: friction has no constant direction.'
    solid('sphere-slides-askew', 'A sphere slides along (3, 4): slip keeps its direction.', KELLER, *ball, (3, 4, -1), (0, 0, 0), 0.2, 0.8)
    solid('sphere-stops-askew', 'The same with a slip that stops.', KELLER, *ball, (0.3, 0.4, -1), (0, 0, 0), 0.4, 0.8)
    solid('sphere-spins-about-its-normal', 'Spin about the normal has no effect at a point contact, and stays.', KELLER, *ball,
          (1, 0, -1), (0, 0, 30), 0.2, 0.8)
    solid('ball-with-spin-on-a-cushion', 'A billiard ball with side and top spin strikes a cushion; the normal is its z axis.',
          'github.com/ekiefl/pooltool issue 153; Y. Han (2005), dynamics in carom and three cushion billiards', 1,
          (0.004, 0.004, 0.004), (0, 0.02, -0.098), (0.4, 0, -0.6), (2, -1, 3), 0.14, 0.85)
    solid('box-corner-slides', 'Slip turns and grows: friction has no constant direction.', KELLER, *box, (1, 0.6, -1), (0, 0, 0), 0.2, 0.6)
    solid('box-corner-turns', turning, KELLER, *box, (-0.6, 0.5, -1), (0, 0, 0), 0.3, 0.6)
    solid('box-corner-elastic', turning, KELLER, *box, (-0.6, 0.5, -1), (0, 0, 0), 0.3, 1)
    solid('box-corner-plastic', turning, KELLER, *box, (0.5, -0.8, -1), (0.4, 0.3, 0), 0.25, 0)
    solid('box-corner-sticks', 'Slip turns, stops and does not come back.', KELLER, *box, (-0.6, 0.5, -1), (0, 0, 0), 0.9, 0.6)
    solid('box-corner-slips-again', 'A contact without slip is set slipping, in the direction that the coupling gives it.', KELLER, *box, (0, 0, -1), (0, 0, 0),
          0.2, 0.6)
    solid('plate-corner', 'A plate strikes with a corner: W is far from isotropic.', KELLER, 1, (0.02, 0.03, 0.05), (0.3, 0.2, -0.05),
          (0.8, -0.4, -1), (0, 0, 0), 0.35, 0.5)
    solid('plate-corner-spins', 'The same plate with spin.', KELLER, 1, (0.02, 0.03, 0.05), (0.3, 0.2, -0.05), (0, 0, -1), (1, -1, 4),
          0.35, 0.5)
    solid('rod-in-its-plane', 'A body in space that strikes within its plane of symmetry: the planar answer.', OWN, 1,
          (ROD, ROD, ROD), (0.35, 0, -0.35), (-0.2, 0, -1), (0, 0, 0), 0.3, 0.5)


def moving_surfaces():
    family = 'moving-surface'
    for name, one, velocity, rate, surface, friction, e in (
            ('ball-on-conveyor', BALL, (0, -1), 0, (2, 0), 0.25, 0.5),
            ('ball-on-conveyor-keeps-pace', BALL, (2, -1), 0, (2, 0), 0.25, 0.5),
            ('rod-on-conveyor', (1, ROD, (0.35, -0.35)), (0, -1), 0, (0.2, 0), 0.3, 0.6),
            ('ball-on-lift', BALL, (0.5, -1), 0, (0, 1), 0.3, 0.8)):
        single(name, family, 'The surface moves: laws hold for the velocity relative to it, and it may give energy.', OWN, *one,
               velocity, rate, friction, e, frame_velocity=[*surface, 0])


def degenerate():
    family = 'degenerate'
    mechanism('slider-on-vertical-rail', family, 'The contact cannot slide: W_tt = 0, and friction does nothing.', OWN, [[2]],
              [[0], [1]], [-1], [(0.5, 0.5)])
    mechanism('slider-on-sloping-rail', family, 'One coordinate: slip and normal velocity stop together. Friction does not lock it.',
              OWN, [[2]], [[0.5], [0.75]], [-1], [(0.5, 0.6)])
    mechanism('slider-locks-on-flat-rail', family, 'The same on a flatter rail: friction locks it.', OWN, [[2]], [[1], [0.25]], [-1],
              [(0.5, 0.6)])
    mechanism('two-coordinates-of-one-direction', family, 'W has rank one although the mechanism has two coordinates.', OWN,
              [[1, 0], [0, 2]], [[0.5, 0.25], [1, 0.5]], [-1, 0.5], [(0.25, 0.8)])
    mechanism('idle-coordinate', family, 'A coordinate that the contact does not move keeps its rate.', OWN,
              [[1, 0, 0], [0, 1, 0], [0, 0, 3]], [[1, 0, 0], [0.5, 1, 0]], [-0.5, -1, 7], [(0.25, 0.5)])


def several():
    family = 'several-contacts'

    def row(name, shows, source, masses, speeds, e, wall=False, **rest):
        """Balls of 0.1 m in a row along x that touch each other, and perhaps a wall at the right end."""
        bodies = [body(m, 0.004, (0.2 * i, 0), (v, 0)) for i, (m, v) in enumerate(zip(masses, speeds))]
        contacts = [contact(0, e, (0.2 * i + 0.1, 0), (1, 0), i + 2, i + 1) for i in range(len(masses) - 1)]
        if wall:
            contacts.append(contact(0, e, (0.2 * len(masses) - 0.1, 0), (-1, 0), len(masses)))
        add_bodies(name, family, shows, source, bodies, contacts, **rest)

    row('cradle-of-three', 'Every order gives (0, 0, 1); equal springs give (-0.13, 0.15, 0.98).', 'github.com/ModiaSim/Modia3D.jl: '
        "Newton's cradle with gaps tuned by trial and error", (1, 1, 1), (1, 0, 0), 1)
    row('cradle-of-three-half', 'The same at a coefficient of 1/2.', OWN, (1, 1, 1), (1, 0, 0), 0.5)
    row('cradle-of-five', 'Five balls: the one at the end leaves with almost all.', "Newton's cradle", (1,) * 5, (1, 0, 0, 0, 0), 1)
    row('squeezed-ball-2', 'A ball of 2 kg between two of 1 kg that close in: the order of impacts matters.',
        'github.com/viblo/pymunk issue 119: the result depends on the order of insertion', (1, 2, 1), (1, 0, -1), 1,
        symmetries=[[-7, 8, -9, -4, 5, -6, -1, 2, -3]])
    row('squeezed-ball-3', 'The same with 3 kg.', 'github.com/viblo/pymunk issue 119', (1, 3, 1), (1, 0, -1), 1,
        symmetries=[[-7, 8, -9, -4, 5, -6, -1, 2, -3]])
    row('squeezed-ball-1', 'With three equal balls the order does not matter.', OWN, (1, 1, 1), (1, 0, -1), 1,
        symmetries=[[-7, 8, -9, -4, 5, -6, -1, 2, -3]])
    row('two-balls-and-a-wall', 'The energy must not double.', 'github.com/keenon/nimblephysics issue 143', (1, 1), (2, 0), 1, wall=True)
    row('tapered-chain', 'Each pair of balls has its own gap; a reference that shares one among all gains energy.',
        'github.com/siconos/siconos-tutorials, TaperedChainOfBalls', (1, 0.75, 0.5, 0.25), (1, 0, 0, 0), 1)

    def block(name, shows, source, friction, e, velocity=(0, -1), **rest):
        add_bodies(name, family, shows, source, [body(1, 5 / 12, (0, 1), velocity)],
                   [contact(friction, e, (-0.5, 0)), contact(friction, e, (0.5, 0))], **rest)

    mirror = {'symmetries': [[-1, 2, -3]]}
    block('block-falls-flat', 'A block of 1 m by 2 m falls flat: which corner is hit first decides which way it turns.',
          'github.com/dimforge/rapier issue 668: a symmetric box bounces asymmetrically', 1, 0.5, **mirror)
    block('block-falls-flat-plastic', 'The same without restitution.', 'github.com/dimforge/rapier issue 668', 1, 0, **mirror)
    block('block-falls-flat-elastic', 'The same without friction and with all restitution.', 'github.com/erincatto/box3d issue 83', 0, 1,
          **mirror)
    add_bodies('ball-in-right-corner', family, 'A ball strikes the floor and a wall at once: the two do not know of each other.', OWN,
               [body(1, 0.004, (0, 0), (1, -2))], [contact(0, 0.8, (0, -0.1)), contact(0, 0.8, (0.1, 0), (-1, 0))])
    add_bodies('ball-in-rough-corner', family, 'The same with friction: spin couples floor and wall.', OWN,
               [body(1, 0.004, (0, 0), (1, -2))], [contact(0.2, 0.8, (0, -0.1)), contact(0.2, 0.8, (0.1, 0), (-1, 0))])


def cases():
    if not CASES:
        for family in (frictionless, sliding, sticking, reversal, jamming, extreme_directions, pendulums, linkages, pairs, space,
                       moving_surfaces, degenerate, several):
            family()
    return CASES
