"""Holds the JSON Schema of scenes to the scenes of this project, and to scenes that the command line refuses.

usage: schema_test.py RICOCHET SCENE_FILE...
"""

import copy
import json
import subprocess
import sys
import unittest

import jsonschema

SCENES = sys.argv[2:]
RICOCHET = sys.argv[1]
sys.argv = sys.argv[:1]


def run(*arguments, text=None):
    return subprocess.run([RICOCHET, *arguments], input=text, capture_output=True, text=True, check=False)


def scene_of(path):
    done = run("scene", "print", "--json", "--scene", path)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def numbers(node, path=()):
    """The path of every number in a document."""
    if isinstance(node, dict):
        for key, value in node.items():
            yield from numbers(value, path + (key,))
    elif isinstance(node, list):
        for index, value in enumerate(node):
            yield from numbers(value, path + (index,))
    else:
        yield path


def at(document, path):
    for key in path:
        document = document[key]
    return document


def changed(document, path, value):
    """A copy with another value at `path`; None takes it away."""
    made = copy.deepcopy(document)
    if value is None:
        del at(made, path[:-1])[path[-1]]
    else:
        at(made, path[:-1])[path[-1]] = value
    return made


class SchemaTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.schema = json.loads(run("scene", "schema").stdout)
        cls.validator = jsonschema.Draft202012Validator(cls.schema)
        cls.scenes = {path: scene_of(path) for path in SCENES}

    def takes(self, scene):
        return self.validator.is_valid(scene)

    def solves(self, scene):
        return run("scene", "print", "--scene", "-", text=json.dumps(scene)).returncode == 0

    def test_is_a_schema_of_the_draft(self):
        jsonschema.Draft202012Validator.check_schema(self.schema)

    def test_takes_every_scene_of_this_project(self):
        self.assertGreater(len(self.scenes), 12)
        for path, scene in self.scenes.items():
            with self.subTest(path):
                self.assertEqual(list(self.validator.iter_errors(scene)), [])

    def test_refuses_what_the_command_line_refuses_of_single_numbers(self):
        refused = 0
        templates = {file: scene for file, scene in self.scenes.items() if "templates" in file}
        for file, scene in templates.items():
            for path in numbers(scene):
                for value in (-1.5, 7, None):
                    if value is None and isinstance(path[-1], int):
                        continue
                    bad = changed(scene, path, value)
                    if self.takes(bad):
                        continue
                    refused += 1
                    with self.subTest(file=file, path=path, value=value):
                        self.assertFalse(self.solves(bad))
        self.assertGreater(refused, 20)

    def test_refuses_ranges_lengths_choices_and_names(self):
        body = self.scenes[next(path for path in SCENES if path.endswith("templates/spatial_body.textproto"))]
        pendulum = self.scenes[next(path for path in SCENES if path.endswith("templates/pendulum.textproto"))]
        spoiled = [
            changed(body, ("spatial_body", "mass_kg"), 0),
            changed(body, ("spatial_body", "mass_kg"), None),
            changed(body, ("spatial_body", "offset_m"), [0, 0]),
            changed(body, ("spatial_body", "inertia_com_kg_m2"), [1, 0, 0, 1, 0, 1, 1]),
            changed(body, ("spatial_body", "mass_g"), 1),
            changed(body, ("spatial_body",), None),
            changed(pendulum, ("friction", "kinetic_coefficient"), -0.1),
            changed(pendulum, ("restitution", "energetic"), 1.1),
            changed(pendulum, ("restitution", "newton"), 0.5),
            changed(pendulum, ("planar_contact",), {"normal_m_s": -1}),
            changed(pendulum, ("pendulum", "a_m"), "0.3 m"),
        ]
        for scene in spoiled:
            with self.subTest(scene):
                self.assertFalse(self.takes(scene))
                self.assertFalse(self.solves(scene))

    def test_units_and_descriptions_come_from_the_protos(self):
        spring = self.schema["$defs"]["LinearSpring"]["properties"]["stiffness_n_m"]
        self.assertEqual(spring["unit"], "N/m")
        self.assertEqual(spring["exclusiveMinimum"], 0)
        self.assertEqual(spring["description"], "k, stiffness, N/m. > 0. Required.")


if __name__ == "__main__":
    unittest.main()
