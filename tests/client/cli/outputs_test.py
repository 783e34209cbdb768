"""Every subcommand, every flag that names an output, and every place where that output can be.

The subcommands and their flags are those that the program itself declares, so that a new one cannot be forgotten here: it
fails the first test until its name stands in COMMANDS.

usage: outputs_test.py RICOCHET DESCRIBE WORK_DIRECTORY
"""
import contextlib
import csv
import io
import itertools
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest
import xml.etree.ElementTree

WORK, DESCRIBE, RICOCHET = [pathlib.Path(sys.argv.pop()).resolve() for _ in range(3)]
INPUTS = WORK / "inputs"
WRONG, FAILED, TRY_AGAIN = 2, 42, 75

SCENE = '{"pendulum":{"inertia_kg_m2":1,"a_m":0.3,"b_m":1,"omega_minus_rad_s":-1},"restitution":{"energetic":1}}'
PENDULUM = ["--a", "0.3", "--b", "1", "--energetic", "1"]
# A sweep with more points than a table on standard output shows.
GRID = ["--axis", "friction.kinetic_coefficient=lin:0:0.4:60", "--column", "coefficients.newton"]
ROWS = "friction.kinetic_coefficient\n" + "0.1\n" * 60
OBSERVED = "rates_after_rad_s[0]\n0.5\n0.6\n"
ANSWERS = "case,law,velocity_after\npendulum-2-paper,newton,1\n" \
    "rod-sticks-elastic,newton,-0.8631713554987213,0.6163682864450127,1.9181585677749362\n"
REQUEST = json.dumps({"scene": json.loads(SCENE), "columns": ["coefficients.newton"], "axes": [
    {"path": "friction.kinetic_coefficient", "list": {"values": [0.1, 0.2, 0.3]}}]})
SWEEP_CSV = "index,friction.kinetic_coefficient,coefficients.newton\n0,0.1,0.7\n1,0.2,0.6\n2,0.3,0.5\n"

# These words follow those of a subcommand so that it answers, once for each way in which it writes something else.
COMMANDS = {
    "solve": [PENDULUM, [*PENDULUM, "--data", str(INPUTS / "rows.csv")]],
    "bounds": [[*PENDULUM, "--mu", "0.1"]],
    "sweep": [[*PENDULUM, *GRID]],
    "merge": [[str(INPUTS / "parts")]],
    "plot": [[str(INPUTS / "sweep.csv")]],
    "multicontact": [["--scene", str(INPUTS / "box.textproto")]],
    "audit": [[*PENDULUM, "--observed-rate", "0.5"], [*PENDULUM, "--data", str(INPUTS / "observed.csv")]],
    "fit": [[*PENDULUM, "--data", str(INPUTS / "observed.csv"), "--unknown", "energetic", "--sigma", "rates_after_rad_s[0]=0.1"]],
    "cost": [[*PENDULUM, "--time-limit", "20ms", "--samples", "1"]],
    "conformance list": [["--family", "stick"]],
    "conformance show": [["rod-jams"]],
    "conformance grade": [[str(INPUTS / "answers.csv"), "--case", "pendulum-2-paper", "--case", "rod-sticks-elastic"]],
    "info": [[]],
    "scene list": [[]],
    "scene template": [["pendulum"]],
    "scene print": [PENDULUM],
    "scene schema": [[]],
    "scene fields": [PENDULUM],
    "scene columns": [PENDULUM],
}
# Options that speak of files or paths and are no names of files to read or to write.
NO_FILES = {"--axis", "--range", "--server", "merge file"}
# The file of each option that reads one holds this.
CONTENT = {"--scene": SCENE, "--request": REQUEST, "plot file": SWEEP_CSV, "solve --data": ROWS, "audit --data": OBSERVED, "fit --data": OBSERVED,
           "conformance grade ANSWERS": ANSWERS, "--config": 'deadline = "5s"\n', "--token-file": "secret\n"}
ENDINGS = {"text": ["txt"], "textproto": ["textproto", "txtpb", "pbtxt", "txt"], "json": ["json"], "jsonl": ["jsonl"],
           "csv": ["csv"], "npy": ["npy"], "netcdf": ["nc"]}
PICTURES = {"svg": (b"<?xml", b"</svg>"), "png": (b"\x89PNG", b"IEND\xaeB`\x82"), "pdf": (b"%PDF", b"%%EOF")}


def run(words, *arguments, stdin=None, environment=None):
    done = subprocess.run([RICOCHET, *words.split(), *map(str, arguments)], cwd=WORK, stdin=stdin or subprocess.DEVNULL,
                          capture_output=True, check=False, timeout=120, env={**os.environ, **(environment or {})})
    return done.returncode, done.stdout, done.stderr.decode()


def leaves(command, words=()):
    subs = command.get("commands", [])
    for sub in subs:
        yield from leaves(sub, (*words, sub["name"]))
    if not subs:
        yield " ".join(words), command["options"]


def described():
    text = subprocess.run([DESCRIBE], capture_output=True, check=True, timeout=120).stdout
    program = next(one for one in json.loads(text)["programs"] if one["name"] == "ricochet")
    return dict(leaves(program))


def flag_of(option):
    """The shortest name of an option, or that of a file which stands without one."""
    return option["names"][0] if option["names"] else option["positional"]


class Flag:
    """A flag that names an output, with all endings of its files and the format that each of them says."""

    def __init__(self, words, options, option):
        self.words, self.name = words, flag_of(option)
        formats = next((one["value"].split("|") for one in options if "--format" in one["names"]), ["json"])
        if ".svg" in option["value"]:
            self.kinds = {ending: ending for ending in PICTURES}
        elif ".html" in option["value"]:
            self.kinds = {"html": "html", "htm": "html"}
        else:
            self.kinds = {ending: kind for kind in formats for ending in ENDINGS[kind]}
        self.is_answer = not set(self.kinds.values()) & {"svg", "html"}
        self.has_choice = self.is_answer and len(formats) > 1

    def __str__(self):
        return f"{self.words} {self.name}"


DESCRIBED = described()
FLAGS = [Flag(words, options, option) for words, options in DESCRIBED.items() for option in options
         if option["file"] == "written"]
# Each flag with each way of its subcommand. There is no picture and no page of solve --data.
CASES = [(flag, base) for flag in FLAGS for base in COMMANDS.get(flag.words, [])
         if not ("--data" in base and str(flag) in ("solve --plot", "solve --html"))]


def without_time(text):
    return re.sub(rb"points? in [0-9.e+-]+ s", b"points in T s", text)


def snapshot(*folders):
    """All that can be seen of the files below: names, modes, links and contents."""
    found = {}
    for path in itertools.chain(*(sorted(folder.rglob("*")) for folder in folders)):
        status = path.lstat()
        content = os.readlink(path) if path.is_symlink() else path.read_bytes() if path.is_file() else None
        found[str(path)] = status.st_mode, status.st_ino, content
    return found


def fill(folder, name="fill"):
    """Leaves no byte free on the disk of the folder."""
    with open(folder / name, "wb", buffering=0) as filler:
        with contextlib.suppress(OSError):
            while filler.write(bytes(4096)):
                pass


@contextlib.contextmanager
def disk(folder):
    """A small disk, which only root can mount."""
    folder.mkdir()
    done = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=256k", "tmpfs", folder], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise unittest.SkipTest(f"no disk can be mounted here: {done.stderr.strip()}")
    try:
        yield folder
    finally:
        subprocess.run(["umount", "--lazy", folder], check=False)


def each_case(test):
    """Makes a test of one case that of all, each in an empty folder."""
    def each(self):
        for flag, base in CASES:
            with self.subTest(command=flag.words, flag=flag.name, arguments=" ".join(base)):
                self.setUp()
                test(self, flag, base)
    return each


class Outputs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        INPUTS.mkdir(parents=True)
        (INPUTS / "rows.csv").write_text(ROWS)
        (INPUTS / "observed.csv").write_text(OBSERVED)
        (INPUTS / "answers.csv").write_text(ANSWERS)
        (INPUTS / "sweep.csv").write_text(SWEEP_CSV)
        code, box, error = run("scene", "template", "box_on_two_feet")
        assert code == 0, error
        (INPUTS / "box.textproto").write_bytes(box)
        for index in "01":
            code, _, error = run("sweep", *PENDULUM, *GRID, "--shard-index", index, "--shard-count", 2, "-o", INPUTS / "parts")
            assert code == 0, error

    def setUp(self):
        self.place = WORK / "place"
        shutil.rmtree(self.place, ignore_errors=True)
        self.place.mkdir()

    def beside(self, flag):
        """Where the answer goes if the flag names another file, so that standard output is free."""
        return [] if flag.is_answer or flag.words == "plot" else ["-o", "/dev/null"]

    def assert_right(self, flag, base, kind, content):
        """The content is the whole answer in its format."""
        if kind in PICTURES:
            start, end = PICTURES[kind]
            self.assertTrue(content.startswith(start) and content.rstrip(b"\n").endswith(end), content[:20])
            if kind == "svg":
                xml.etree.ElementTree.fromstring(content)
        elif kind == "html":
            self.assertTrue(content.startswith(b"<!DOCTYPE html>") and content.endswith(b"</html>\n"))
        elif kind == "netcdf":
            self.assertTrue(content.startswith(b"\x89HDF"))
        elif flag.words == "cost":
            # Its times differ from run to run.
            {"text": lambda: self.assertRegex(content, rb"^\d+ methods? for one impact"),
             "json": lambda: self.assertIn("rows", json.loads(content)),
             "csv": lambda: self.assertGreater(len(list(csv.DictReader(io.StringIO(content.decode())))), 1)}[kind]()
        elif kind == "text" and "--data" not in base and flag.words in ("sweep", "merge"):
            self.assertEqual(len(re.findall(rb"(?m)^\d+ ", content)), 61, content)  # Sixty points, and their count.
            self.assertNotIn(b"more points", content)
        elif kind == "text" and flag.words == "solve" and "--data" in base:
            self.assertEqual(len(re.findall(rb"(?m)^\d+ ", content)), 61, content)
            self.assertNotIn(b"more rows", content)
        else:
            code, out, error = run(flag.words, *base, *(["--format", kind] if flag.has_choice else []))
            self.assertEqual(code, 0, error)
            self.assertEqual(content, out)

    def assert_written(self, flag, base, path, kind, *more):
        code, out, error = run(flag.words, *base, *self.beside(flag), flag.name, path, *more)
        self.assertEqual(code, 0, error)
        if flag.words != "plot":
            self.assertEqual(out, b"")
        self.assert_right(flag, base, kind, pathlib.Path(path).read_bytes())

    def assert_refused(self, words, *arguments, code=WRONG, says="", **more):
        """The command fails so, prints nothing and changes no file."""
        before = snapshot(self.place, INPUTS)
        found, out, error = run(words, *arguments, **more)
        self.assertEqual((found, out), (code, b""), error)
        self.assertIn(says, error)
        self.assertEqual(snapshot(self.place, INPUTS), before)
        return error

    def test_each_file_option_is_known_and_each_command_with_an_output_is_tried(self):
        for words, options in DESCRIBED.items():
            for option in options:
                speaks_of_files = "FILE" in option["value"] + option["positional"].upper() or "PATH" in option["value"]
                known = bool(option["file"]) or bool({flag_of(option), f"{words} {flag_of(option)}"} & NO_FILES)
                self.assertTrue(known or not speaks_of_files, f"{words} {flag_of(option)}")
        self.assertEqual({flag.words for flag in FLAGS}, set(COMMANDS))
        self.assertGreaterEqual({flag.name for flag in FLAGS}, {"-o", "--plot", "--html"})

    @each_case
    def test_a_file_has_the_format_that_its_ending_says_in_any_case(self, flag, base):
        for ending, kind in flag.kinds.items():
            for name in (f"out.{ending}", f"out.{ending.upper()}"):
                path = self.place / name
                self.assert_written(flag, base, path, kind)
                self.assertEqual(os.listdir(self.place), [name])
                path.unlink()

    @each_case
    def test_the_flag_says_the_format_of_a_name_that_says_none(self, flag, base):
        for kind in sorted(set(flag.kinds.values())) if flag.has_choice else []:
            for name in ("out", "out.v2"):
                self.assert_written(flag, base, self.place / name, kind, "--format", kind)

    @each_case
    def test_an_ending_that_says_something_else_is_refused(self, flag, base):
        for ending in ("csv", "json", "jsonl", "npy", "nc", "txt", "textproto", "svg", "png", "pdf", "gif", "html", "xlsx", "gz", ""):
            path = self.place / f"out.{ending}" if ending else self.place / "out"
            if ending in flag.kinds:
                continue
            error = self.assert_refused(flag.words, *base, *self.beside(flag), flag.name, path, says=f"ricochet: {flag.name} {path}: must end in ")
            meant = "--plot" if ending in ("svg", "png", "pdf", "gif") else "--html" if ending == "html" else None
            has_meant = any(meant in option["names"] for option in DESCRIBED[flag.words])
            self.assertEqual(f"did you mean {meant} {path}?" in error, flag.is_answer and has_meant, error)

    @each_case
    def test_a_flag_that_contradicts_the_ending_is_refused(self, flag, base):
        for ending in (*flag.kinds, "png", "html") if flag.has_choice else ():
            for kind in set(flag.kinds.values()):
                if ending not in ENDINGS[kind]:
                    self.assert_refused(flag.words, *base, flag.name, self.place / f"out.{ending}", "--format", kind,
                                        says=f"must not end in .{ending} beside --format {kind}")

    @each_case
    def test_an_empty_name_is_refused(self, flag, base):
        self.assert_refused(flag.words, *base, *self.beside(flag), flag.name, "", says=f"ricochet: {flag.name}: must have a value")

    @each_case
    def test_minus_is_standard_output_where_text_can_go_there(self, flag, base):
        for kind in sorted(set(flag.kinds.values())):
            wanted = ["--format", kind] if flag.has_choice else []
            if kind == "netcdf":
                self.assert_refused(flag.words, *base, flag.name, "-", *wanted)
            elif kind in ("png", "pdf"):
                continue  # Standard output gets the first kind of pictures.
            elif flag.is_answer and flag.words != "cost":
                expected = run(flag.words, *base, *wanted)
                for name in ("-", "/dev/stdout"):
                    code, out, error = run(flag.words, *base, flag.name, name, *wanted)
                    self.assertEqual((code, without_time(out)), (0, without_time(expected[1])), error)
            else:
                code, out, error = run(flag.words, *base, *self.beside(flag), flag.name, "-", *wanted)
                self.assertEqual(code, 0, error)
                self.assert_right(flag, base, kind, out)
            if self.beside(flag):
                self.assert_refused(flag.words, *base, flag.name, "-", says=f"{flag.name} - and standard output are one file")
        self.assertEqual(os.listdir(self.place), [])
        self.assertFalse((WORK / "-").exists())

    @each_case
    def test_a_link_stays_and_its_target_is_written(self, flag, base):
        for ending, kind in flag.kinds.items():
            for exists in (False, True):
                target, link, far = self.place / "folder" / "target", self.place / f"link.{ending}", self.place / "far"
                target.parent.mkdir()
                if exists:
                    target.write_text("old")
                far.symlink_to("folder/target")
                link.symlink_to("far")
                self.assert_written(flag, base, link, kind)
                self.assertEqual((os.readlink(link), os.readlink(far)), ("far", "folder/target"))
                self.assertTrue(target.is_file() and not target.is_symlink())
                self.assertEqual(os.listdir(target.parent), ["target"])
                self.setUp()

    def reading(self, words, base, option, path):
        """The arguments by which a subcommand reads `path` for an option, and the content of such a file."""
        flag = flag_of(option)
        content = CONTENT.get(flag, CONTENT.get(f"{words} {flag}", "PEM\n"))
        if not option["names"]:
            return [path], content
        arguments = [] if flag == "--request" else base
        if flag == "--scene":
            arguments = base[len(PENDULUM):] if base[:len(PENDULUM)] == PENDULUM else base
            arguments = arguments[2:] if arguments[:1] == [flag] else arguments
        if flag == "--data":
            arguments = [one for i, one in enumerate(arguments) if flag not in (one, arguments[i - 1])]
            arguments = [one for i, one in enumerate(arguments) if "--observed-rate" not in (one, arguments[i - 1])]
        if flag in ("--tls-ca", "--tls-cert", "--tls-key", "--token-file", "--config"):
            arguments = [*arguments, "--server", "127.0.0.1:1"]
        return [*arguments, flag, path], content

    @each_case
    def test_an_input_is_never_written_over(self, flag, base):
        ending, kind = next(iter(flag.kinds.items()))
        for option in (one for one in DESCRIBED[flag.words] if one["file"] == "read"):
            original = self.place / f"input.{ending}"
            arguments, content = self.reading(flag.words, base, option, original)
            original.write_text(content)
            (self.place / f"hard.{ending}").hardlink_to(original)
            (self.place / f"soft.{ending}").symlink_to(original.name)
            names = [original, self.place / "." / original.name, f"place/{original.name}", self.place / f"hard.{ending}",
                     self.place / f"soft.{ending}"]
            for name in names:
                said = f"{flag.name} {name} would be written over {flag_of(option) if option['names'] else ''}".strip()
                self.assert_refused(flag.words, *arguments, *self.beside(flag), flag.name, name, says=said)
            if flag.is_answer and flag.has_choice:
                self.assert_refused(flag.words, *arguments, flag.name, original, "--format", kind, says="would be written over")
            self.setUp()

    def test_what_is_read_without_a_flag_is_never_written_over(self):
        for name in ("TLS_CA", "TLS_CERT", "TLS_KEY", "TOKEN_FILE", "CONFIG"):
            path = self.place / "file.csv"
            path.write_text(CONTENT["--config"])
            self.assert_refused("solve", *PENDULUM, "--server", "127.0.0.1:1", "-o", path, environment={f"RICOCHET_{name}": str(path)},
                                says="would be written over")
        config = self.place / "config"
        config.write_text(f'token-file = "{path}"\n')
        self.assert_refused("info", "--server", "127.0.0.1:1", "--config", config, "-o", path, says="would be written over")
        scene = self.place / "scene.json"
        scene.write_text(SCENE)
        with open(scene, "rb") as stdin:
            self.assert_refused("solve", "--scene", "-", "-o", scene, stdin=stdin, says="would be written over --scene -")
        for shard in ("parts.shard-0-of-2", "parts.shard-1-of-2.json"):
            self.assert_refused("merge", INPUTS / "parts", "-o", INPUTS / shard, *(["--format", "csv"] if shard.endswith("2") else []),
                                says="would be written over")

    def test_what_a_sweep_writes_beside_its_file_is_no_input(self):
        for name, arguments in {"x.csv.part": ["-o", "x.csv"], "x.csv.part.json": ["-o", "x.csv"],
                                "x.csv.part.json.new": ["-o", "x.csv"],
                                "x.shard-0-of-1.json": ["-o", "x", "--shard-index", "0", "--shard-count", "1"],
                                "x.shard-0-of-1.part.json": ["-o", "x", "--shard-index", "0", "--shard-count", "1"]}.items():
            (self.place / name).write_text(SCENE)
            written = [self.place / one if one.startswith("x") else one for one in arguments]
            self.assert_refused("sweep", *GRID, "--scene", self.place / name, *written, says="would be written over --scene")
            self.setUp()

    def test_the_name_of_a_picture_that_nobody_gave_is_no_input(self):
        sweep = self.place / "sweep.svg"
        sweep.write_text(SWEEP_CSV)
        self.assert_refused("plot", sweep, says=f"{sweep} would be written over {sweep}")

    def test_two_outputs_are_two_files(self):
        for words, bases in COMMANDS.items():
            flags = [flag for flag in FLAGS if flag.words == words]
            for (one, other), base in itertools.product(itertools.combinations(flags, 2), bases):
                for exists in (False, True):
                    with self.subTest(command=words, flags=(one.name, other.name), exists=exists):
                        ending, second = next(iter(one.kinds)), next(iter(other.kinds))
                        path, link = self.place / f"out.{ending}", self.place / f"link.{second}"
                        link.symlink_to(path)
                        if exists:
                            path.write_text("old")
                        self.assert_refused(words, *base, *(self.beside(one) if not other.is_answer else []), one.name, path,
                                            other.name, link, says=" are one file: must be two")
                        self.setUp()

    @each_case
    def test_a_full_disk_means_try_again_and_changes_nothing(self, flag, base):
        for (ending, kind), exists in itertools.product(flag.kinds.items(), (False, True)):
            with disk(self.place / "disk") as folder:
                path = folder / f"out.{ending}"
                if exists:
                    path.write_text("old")
                fill(folder)
                for room in (False, True):
                    if room:  # Enough for a name and a manifest, and not for the content.
                        os.truncate(folder / "fill", (folder / "fill").stat().st_size - 4096)
                    if room and kind not in ("netcdf", "svg", "html"):
                        continue
                    self.assert_refused(flag.words, *base, *self.beside(flag), flag.name, path, code=TRY_AGAIN,
                                        says="RESOURCE_EXHAUSTED")
            self.setUp()

    def test_a_full_disk_means_try_again_for_a_shard(self):
        with disk(self.place / "disk") as folder:
            fill(folder)
            self.assert_refused("sweep", *PENDULUM, *GRID, "-o", folder / "x", "--shard-index", 0, "--shard-count", 1,
                                code=TRY_AGAIN, says="RESOURCE_EXHAUSTED")

    def test_a_disk_that_becomes_full_leaves_the_old_file_and_at_most_the_first_part(self):
        for kind, endings in ENDINGS.items():
            with self.subTest(kind=kind):
                if kind == "textproto":
                    continue
                with disk(self.place / "disk") as folder:
                    path = folder / f"out.{endings[0]}"
                    path.write_text("old")
                    code, out, error = run("sweep", *PENDULUM, "--axis", "friction.kinetic_coefficient=lin:0:0.4:50000", "-o", path)
                    self.assertEqual((code, out), (TRY_AGAIN, b""), error)
                    self.assertIn("RESOURCE_EXHAUSTED", error)
                    self.assertEqual(path.read_text(), "old")
                    parts = {f"{path.name}.part", f"{path.name}.part.json"} if kind not in ("text", "netcdf") else set()
                    self.assertLessEqual(set(os.listdir(folder)) - {path.name}, parts)
                    self.assertEqual("--resume" in error, len(os.listdir(folder)) > 1)
                self.setUp()

    @each_case
    def test_a_folder_that_cannot_be_written_fails_and_changes_nothing(self, flag, base):
        for ending in flag.kinds:
            self.assert_refused(flag.words, *base, *self.beside(flag), flag.name, self.place / "absent" / f"out.{ending}",
                                code=FAILED, says="cannot write")
            (self.place / f"folder.{ending}").mkdir()
            self.assert_refused(flag.words, *base, *self.beside(flag), flag.name, self.place / f"folder.{ending}",
                                code=FAILED, says="cannot write")
            (self.place / f"folder.{ending}").rmdir()

    def test_a_disk_that_is_read_only_fails_and_changes_nothing(self):
        with disk(self.place / "disk") as folder:
            for flag in FLAGS:
                for ending in flag.kinds:
                    (folder / f"old.{ending}").write_text("old")
            subprocess.run(["mount", "-o", "remount,ro", folder], check=True)
            for flag, base in CASES:
                for ending, name in itertools.product(flag.kinds, ("new", "old")):
                    with self.subTest(command=flag.words, flag=flag.name, ending=ending, name=name):
                        self.assert_refused(flag.words, *base, *self.beside(flag), flag.name, folder / f"{name}.{ending}",
                                            code=FAILED, says="cannot write")


if __name__ == "__main__":
    unittest.main()
