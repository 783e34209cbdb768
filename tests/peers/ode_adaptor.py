"""Takes the conformance cases in the Open Dynamics Engine: ode_adaptor.py IMPACTS.json STEPPER ANSWERS.csv

STEPPER is World (a direct solver) or a number of iterations of QuickStep. Contacts are stated as joints, without shapes,
so that the engine's collisions have no part in the answers. Cases in a plane lie in x and y; pins are hinges about z.
"""
import ctypes
import json
import sys

STEP, SOFTENING = 1e-3, 1e-11
BOUNCE, FDIR1, APPROX1, MOTION = 0x4, 0x2, 0x7000, (0x20, 0x40, 0x80)
Vector, Real = ctypes.c_double * 4, ctypes.c_double


class Contact(ctypes.Structure):
    _fields_ = [("mode", ctypes.c_int), *[(name, Real) for name in (
        "mu", "mu2", "rho", "rho2", "rhoN", "bounce", "bounce_vel", "soft_erp", "soft_cfm", "motion1", "motion2", "motionN",
        "slip1", "slip2")], ("pos", Vector), ("normal", Vector), ("depth", Real), ("geoms", ctypes.c_void_p * 2),
                ("sides", ctypes.c_int * 2), ("fdir1", Vector)]


class Mass(ctypes.Structure):
    _fields_ = [("mass", Real), ("c", Vector), ("I", Real * 12)]


LIBRARY = ctypes.CDLL("libode.so.8")


def ode(name, *arguments, result=ctypes.c_void_p):
    function = getattr(LIBRARY, "d" + name)
    function.restype = result
    found = function(*[Real(x) if isinstance(x, (int, float)) else x for x in arguments])
    return ctypes.c_void_p(found) if result is ctypes.c_void_p else found


def three(numbers):
    return [*numbers, 0.0][:3]


def contact_of(case, one):
    normal = three(one["normal"])
    made = Contact(mode=BOUNCE | FDIR1 | APPROX1, mu=one["friction"], mu2=one["friction"], bounce=one["coefficient"])
    made.pos, made.normal = Vector(*three(one["point_m"])), Vector(*normal)
    made.fdir1 = Vector(normal[1], -normal[0], 0) if case["dimension"] == 2 else Vector(1, 0, 0)
    if "frame_velocity" in case:  # All of these surfaces lie along x.
        made.mode |= MOTION[0] | MOTION[2]
        made.motion1, made.motionN = case["frame_velocity"][0], case["frame_velocity"][1]
    return made


def velocities_after(case, stepper):
    world, bodies = ode("WorldCreate"), [None]
    ode("WorldSetCFM", world, SOFTENING * STEP)
    for one in case["bodies"]:
        body, planar = ode("BodyCreate", world), case["dimension"] == 2
        inertia = [one["inertia_com_kg_m2"]] * 3 if planar else one["inertia_com_kg_m2"]
        mass = Mass()
        ode("MassSetParameters", ctypes.byref(mass), one["mass_kg"], 0, 0, 0, *inertia, 0, 0, 0)
        ode("BodySetMass", body, ctypes.byref(mass))
        ode("BodySetPosition", body, *three(one["centre_m"]))
        ode("BodySetLinearVel", body, *three(one["velocity_m_s"]))
        ode("BodySetAngularVel", body, *((0, 0, one["rate_rad_s"]) if planar else one["rate_rad_s"]))
        ode("BodySetGyroscopicMode", body, ctypes.c_int(0))
        if "pin_m" in one:
            hinge = ode("JointCreateHinge", world, None)
            ode("JointAttach", hinge, body, bodies[-1])
            ode("JointSetHingeAnchor", hinge, *three(one["pin_m"]))
            ode("JointSetHingeAxis", hinge, 0, 0, 1)
        bodies.append(body)
    for one in case["contacts"]:
        joint = ode("JointCreateContact", world, None, ctypes.byref(contact_of(case, one)))
        ode("JointAttach", joint, bodies[one["body"]], bodies[one["other_body"]])
    ode("RandSetSeed", ctypes.c_ulong(1))
    if stepper == "World":
        ode("WorldStep", world, STEP)
    else:
        ode("WorldSetQuickStepNumIterations", world, ctypes.c_int(int(stepper)))
        ode("WorldQuickStep", world, STEP)
    after = []
    for one, body in zip(case["bodies"], bodies[1:]):
        linear, angular = (ode(f"BodyGet{kind}Vel", body, result=ctypes.POINTER(Real)) for kind in ("Linear", "Angular"))
        after += [] if "pin_m" in one else linear[:case["dimension"]]
        after += [angular[2]] if case["dimension"] == 2 else angular[:3]
    ode("WorldDestroy", world)
    return after


ode("InitODE2", ctypes.c_uint(0), result=ctypes.c_int)
with open(sys.argv[1], encoding="utf-8") as cases, open(sys.argv[3], "w", encoding="utf-8") as answers:
    print("case,law,velocity_after", file=answers)
    for one in json.load(cases)["cases"]:
        if "bodies" in one:
            print(f"{one['name']},newton", *velocities_after(one, sys.argv[2]), sep=",", file=answers)
