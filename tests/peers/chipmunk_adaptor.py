"""Takes the conformance cases in Chipmunk: chipmunk_adaptor.py IMPACTS.json ITERATIONS ANSWERS.csv"""
import ctypes
import json
import sys

STEP, DEPTH, RADIUS = 1e-9, 1e-7, 0.01  # s; the overlap at the start, m; the ball at a contact, m


class Vect(ctypes.Structure):
    _fields_ = [("x", ctypes.c_double), ("y", ctypes.c_double)]


LIBRARY = ctypes.CDLL("libchipmunk.so.7")


def chipmunk(name, *arguments, result=ctypes.c_void_p):
    function = getattr(LIBRARY, "cp" + name)
    function.restype = result
    return function(*[ctypes.c_double(x) if isinstance(x, (int, float)) else x for x in arguments])


def velocities_after(case, iterations):
    space = ctypes.c_void_p(chipmunk("SpaceNew"))
    chipmunk("SpaceSetIterations", space, ctypes.c_int(iterations))
    bodies = [ctypes.c_void_p(chipmunk("SpaceGetStaticBody", space))]
    for one in case["bodies"]:
        body = ctypes.c_void_p(chipmunk("BodyNew", one["mass_kg"], one["inertia_com_kg_m2"]))
        chipmunk("SpaceAddBody", space, body)
        chipmunk("BodySetPosition", body, Vect(*one["centre_m"]))
        chipmunk("BodySetVelocity", body, Vect(*one["velocity_m_s"]))
        chipmunk("BodySetAngularVelocity", body, one["rate_rad_s"])
        if "pin_m" in one:
            joint = chipmunk("PivotJointNew", bodies[-1], body, Vect(*one["pin_m"]))
            chipmunk("SpaceAddConstraint", space, ctypes.c_void_p(joint))
        bodies.append(body)
    for number, one in enumerate(case["contacts"], 1):
        (x, y), (nx, ny) = one["point_m"], one["normal"]

        def place(body, ahead, along):  # A point near the contact in the frame of a body, which is not turned.
            centre = case["bodies"][body - 1]["centre_m"] if body else (0, 0)
            return Vect(x + ahead * nx + along * ny - centre[0], y + ahead * ny - along * nx - centre[1])
        ball = chipmunk("CircleShapeNew", bodies[one["body"]], RADIUS, place(one["body"], RADIUS - DEPTH, 0))
        wall = chipmunk("SegmentShapeNew", bodies[one["other_body"]], place(one["other_body"], 0, -1),
                        place(one["other_body"], 0, 1), 0)
        for shape, friction, bounce in ((ball, one["friction"], one["coefficient"]), (wall, 1, 1)):  # Products act.
            shape = ctypes.c_void_p(shape)
            chipmunk("ShapeSetFriction", shape, friction)
            chipmunk("ShapeSetElasticity", shape, bounce)
            chipmunk("ShapeSetCollisionType", shape, ctypes.c_size_t(number))
            chipmunk("SpaceAddShape", space, shape)
    chipmunk("SpaceStep", space, STEP)
    after = []
    for one, body in zip(case["bodies"], bodies[1:]):
        velocity = chipmunk("BodyGetVelocity", body, result=Vect)
        after += [] if "pin_m" in one else [velocity.x, velocity.y]
        after.append(chipmunk("BodyGetAngularVelocity", body, result=ctypes.c_double))
    return after


with open(sys.argv[1], encoding="utf-8") as cases, open(sys.argv[3], "w", encoding="utf-8") as answers:
    print("case,law,velocity_after", file=answers)
    for one in json.load(cases)["cases"]:
        if one["dimension"] == 2 and "bodies" in one and "frame_velocity" not in one and len(one["contacts"]) == 1:
            print(f"{one['name']},newton", *velocities_after(one, int(sys.argv[2])), sep=",", file=answers)
