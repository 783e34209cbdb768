"""The answers of the core to the cases of conformance/impacts.json, by the command line.

core_answers.py RICOCHET IMPACTS.json LAW prints an answers file; at several contacts it has the first order found.
"""

import json
import subprocess
import sys


def run(ricochet, words, scene):
    done = subprocess.run([ricochet, *words, '--scene', '-', '--format', 'json'], input=json.dumps(scene),
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f'{words}: {done.stderr}')
    return json.loads(done.stdout)


def mechanism(case):
    return {'mass_matrix': [x for row in case['mass_matrix'] for x in row],
            'jacobian': [x for row in case['jacobian'] for x in row], 'rates': case['velocity_before']}


def scene(case, law):
    """The case as a ricochet.v1.Scene with its coefficient by `law`."""
    one = case['contacts'][0]
    made = {'mechanism': mechanism(case), 'friction': {'kinetic_coefficient': one['friction']},
            'restitution': {law: one['coefficient']}}
    if 'frame_velocity' in case:
        velocity = [sum(j * f for j, f in zip(row, case['frame_velocity'])) for row in case['jacobian']]
        made['surface_velocity'] = {'tangential_m_s': velocity[:-1], 'normal_m_s': velocity[-1]}
    return made


def single(ricochet, case, law):
    """The outcome of a case with one contact."""
    return run(ricochet, ['solve', '--tolerance', '1e-15'], scene(case, law))['outcome']


def certifiable_scene(case):
    """The case as bodies whose numbers the core can prove; none for linkages, for mechanisms and in space."""
    bodies, one = case.get('bodies', []), case['contacts'][0]
    if case['dimension'] == 3 or one.get('normal') != [0, 1] or 'frame_velocity' in case or len(bodies) > 2:
        return None
    if any('pin_m' in body for body in bodies):
        if len(bodies) > 1:
            return None
        (b,), (a,) = case['jacobian']
        system = {'pendulum': {'inertia_kg_m2': case['mass_matrix'][0][0], 'a_m': a, 'b_m': b,
                               'omega_minus_rad_s': case['velocity_before'][0]}}
    else:
        made = [{'mass_kg': body['mass_kg'], 'inertia_com_kg_m2': body['inertia_com_kg_m2'],
                 'offset_t_m': sign * case['jacobian'][1][3 * i + 2], 'offset_n_m': -sign * case['jacobian'][0][3 * i + 2],
                 'velocity_t_m_s': body['velocity_m_s'][0], 'velocity_n_m_s': body['velocity_m_s'][1],
                 'rate_rad_s': body['rate_rad_s']} for i, (body, sign) in enumerate(zip(bodies, (1, -1)))]
        pair = {'body_pair': {'planar': {'body_1': made[0], 'body_2': made[-1]}}}
        system = {'planar_body': made[0]} if len(made) == 1 else pair
    return {**system, 'friction': {'kinetic_coefficient': one['friction']}}


def certified_velocities(case):
    """The paths of the contact velocity in a certificate."""
    return ['contact_velocity_after.tangential_m_s[0]', 'contact_velocity_after.normal_m_s']


def audit(ricochet, case, velocity):
    """Returns what an audit says of a contact velocity after the impact."""
    seen = ','.join(map(repr, velocity))
    return run(ricochet, ['audit', f'--observed-velocity={seen}', '--uncertainty', '1e-9'], scene(case, 'energetic'))['report']


def several(ricochet, case):
    """Returns what the contacts of a case can do."""
    contacts = [{'friction': c['friction'], 'energetic': c['coefficient']} for c in case['contacts']]
    return run(ricochet, ['multicontact'], {'mechanism': mechanism(case), 'contacts': contacts})['answers'][0]


def springs(core):
    """The outcome of springs; none where the core does not bound its error."""
    found = core.get('springs')
    proved = found and found['error_is_proved'] and found['end'] in ('END_SEPARATED', 'END_ENDLESS')
    return found if proved and found['impulse_n_s'] else None


def possible(core, count):
    """Proved bounds on each number after, which no order, stiffness or law that takes energy exceeds."""
    ranges = {one['output']: [one['lower'], one['upper']] for one in core['possible']}
    return [ranges[f'rate_{i + 1}'] for i in range(count)]


def answers(ricochet, cases, law):
    """An answers file of the core."""
    rows = []
    for case in cases:
        one = len(case['contacts']) == 1
        rates = single(ricochet, case, law)['rates_after'] if one else several(ricochet, case)['orders'][0]['velocity']
        rows.append({'case': case['name'], 'velocity_after': rates})
    return {'simulator': 'Ricochet', 'law': law, 'answers': rows}


if __name__ == '__main__':
    with open(sys.argv[2], encoding='utf-8') as file:
        print(json.dumps(answers(sys.argv[1], json.load(file)['cases'], sys.argv[3]), indent=1))
