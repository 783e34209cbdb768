"""The frame of the fault tests: checks with a name and a rule, servers as real processes, calls by foreign clients.

A topic is a file of checks that ends with `framework.main()`:

    python3 tests/fault/TOPIC.py --ricochetd FILE --ricochet FILE --proto DIRECTORY --work DIRECTORY [options]

A check is a function with a name and a rule. Its rule must not depend on the speed of the machine, so that it holds
under load, too. It calls `require` for each part of the rule and returns its figures. The program prints a line for each
check and ends with 1 if one is not level, unless the check states a mitigation: then the guard is known to be missing.
"""

import argparse
import dataclasses
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
import traceback
from pathlib import Path

MIB = 1 << 20
PROCESSORS = os.cpu_count() or 1
# Rounds of a check that compares times: a server that breaks the rule does so in each, a machine that stalls spoils
# one.
TIMED_ROUNDS = 3
LONG_MINUTES = 30  # A long run of fewer minutes tries as much less of what is counted.


class NotLevel(Exception):
    """A rule is broken."""


class Skipped(Exception):
    """A check cannot run here; the text says what is missing."""


def require(condition, text):
    if not condition:
        raise NotLevel(text)


@dataclasses.dataclass
class Check:
    name: str
    rule: str
    run: object
    kind: str  # load, fault or input: the group of the report that the check counts for.
    soak: bool  # If true, the check is too long for the short run.
    mitigation: str  # If the guard is missing on purpose, what to do instead and why.
    timed: bool  # If true, the rule compares times, and the check is level if one of TIMED_ROUNDS rounds is.


CHECKS = []


def check(name, rule, kind="fault", soak=False, mitigation="", timed=False):
    def register(function):
        CHECKS.append(Check(name, rule, function, kind, soak, mitigation, timed))
        return function

    return register


class Tools:
    """The arguments of the program, and what every check may use."""

    def __init__(self, arguments):
        self.ricochetd = Path(arguments.ricochetd).resolve()
        self.ricochet = Path(arguments.ricochet).resolve()
        self.proto = Path(arguments.proto).resolve()
        self.work = Path(arguments.work).resolve()
        self.soak = arguments.soak
        self.minutes = arguments.minutes
        # In the long run: the part of all bad requests and kills that are tried.
        self.part = min(1.0, arguments.minutes / LONG_MINUTES)
        self.seed = arguments.seed
        self.sanitized = arguments.sanitized
        self.help = ""

    def memory_mib(self, most):
        """The most memory that a rule allows; sanitizers keep what was freed."""
        return 4 * most + 600 if self.sanitized else most

    def prepare(self):
        """Makes the Python stubs of the service."""
        self.work.mkdir(parents=True, exist_ok=True)
        stubs = self.work / "stubs"
        shutil.rmtree(stubs, ignore_errors=True)
        stubs.mkdir()
        files = [str(path) for path in sorted([*self.proto.glob("ricochet/**/*.proto"), *self.proto.glob("google/**/*.proto")])]
        plugin = shutil.which("grpc_python_plugin")
        subprocess.run(
            ["protoc", f"-I{self.proto}", f"--python_out={stubs}", f"--grpc_out={stubs}",
             f"--plugin=protoc-gen-grpc={plugin}", *files], check=True)
        sys.path.insert(0, str(stubs))
        self.help = subprocess.run(
            [self.ricochetd, "--help"], capture_output=True, text=True, check=True).stdout

    def has_option(self, name):
        return re.search(rf"^  --{re.escape(name)}\b", self.help, re.MULTILINE) is not None

    def options(self, **wanted):
        """Options by their names with underscores; those that this server does not have are left out."""
        arguments = []
        for name, value in wanted.items():
            flag = name.replace("_", "-")
            if self.has_option(flag):
                arguments += [f"--{flag}"] if value is True else [f"--{flag}", str(value)]
        return arguments

    def random(self, salt=""):
        return random.Random(f"{self.seed} {salt}")


TOOLS = None
_live = []


def tools():
    return TOOLS


class Process:
    """A child process, with what /proc says about it. `limits` are options of prlimit."""

    def __init__(self, command, limits=(), **popen):
        # Programs set up the child, because a function of Python needs a true fork, in which threads of gRPC abort or
        # hang.
        setup = ["setpriv", "--pdeathsig", "KILL", *(["prlimit", *limits] if limits else [])]
        self.child = subprocess.Popen([*setup, *(str(part) for part in command)], **popen)
        self.pid = self.child.pid
        _live.append(self)

    def alive(self):
        return self.child.poll() is None

    def signal(self, number):
        if self.alive():
            os.kill(self.pid, number)

    def wait(self, seconds):
        """Returns the exit code, or None if the process still runs after this time."""
        try:
            return self.child.wait(seconds)
        except subprocess.TimeoutExpired:
            return None

    def kill(self):
        if self.alive():
            self.child.kill()
            self.child.wait()
        if self in _live:
            _live.remove(self)

    def _status(self, key):
        try:
            text = Path(f"/proc/{self.pid}/status").read_text(encoding="ascii")
        except OSError as error:
            raise NotLevel("the server's process is gone") from error
        found = re.search(rf"^{key}:\s+(\d+)", text, re.MULTILINE)
        if found is None:
            raise NotLevel("the server's process is gone")
        return int(found.group(1))

    def rss_mib(self):
        return self._status("VmRSS") / 1024

    def peak_mib(self):
        return self._status("VmHWM") / 1024

    def forget_peak(self):
        Path(f"/proc/{self.pid}/clear_refs").write_text("5", encoding="ascii")

    def threads(self):
        return self._status("Threads")

    def descriptors(self):
        return len(os.listdir(f"/proc/{self.pid}/fd"))

    def wants_processor(self):
        """True if a thread runs or waits for a processor just now."""
        for task in Path(f"/proc/{self.pid}/task").iterdir():
            try:
                if (task / "stat").read_text(encoding="ascii").rpartition(")")[2].split()[0] == "R":
                    return True
            except OSError:
                continue  # The thread has ended.
        return False

    def cpu_s(self):
        fields = Path(f"/proc/{self.pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Server(Process):
    """A running ricochetd on a free port of an address, 127.0.0.1 by default, and on what `also` adds to --listen."""

    count = 0

    def __init__(self, *options, host="127.0.0.1", port=0, also="", limits=(), stderr=None, environment=None, prefix=(),
                 start_s=20, **more):
        Server.count += 1
        self.host = host
        self.directory = TOOLS.work / f"server_{os.getpid()}_{Server.count}"
        shutil.rmtree(self.directory, ignore_errors=True)
        self.directory.mkdir(parents=True)
        self.port_file = self.directory / "port"
        self.log = self.directory / "log"
        command = [*prefix, TOOLS.ricochetd, "--listen", f"{host}:{port}{also}", "--port-file", self.port_file,
                   *options, *TOOLS.options(**more)]
        if stderr is None:
            with open(self.log, "wb") as log:
                super().__init__(command, limits, stderr=log, env={**os.environ, **(environment or {})})
        else:
            super().__init__(command, limits, stderr=stderr, env={**os.environ, **(environment or {})})
        deadline = time.monotonic() + start_s
        while not (self.port_file.exists() and self.port_file.read_text(encoding="ascii").strip()):
            if not self.alive() or time.monotonic() > deadline:
                self.kill()
                raise NotLevel(f"the server did not start: {self.log_text()[-500:]}")
            time.sleep(0.02)
        self.port = int(self.port_file.read_text(encoding="ascii"))
        self.address = f"{host}:{self.port}"

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.kill()
        shutil.rmtree(self.directory, ignore_errors=True)

    def log_text(self):
        return self.log.read_text(encoding="utf-8", errors="replace") if self.log.exists() else ""

    def drain(self, most_s=10.0, code=0):
        """Sends SIGTERM; returns the seconds to the end."""
        start = time.monotonic()
        self.signal(signal.SIGTERM)
        ended = self.wait(most_s)
        took = time.monotonic() - start
        require(ended is not None, f"still runs {took:.1f} s after SIGTERM")
        require(ended == code, f"ended with {ended} after SIGTERM, not {code}")
        return took


class Group:
    """A control group with one limit, of version 1 or 2: "memory" in bytes or "pids" in threads."""

    FILES = {"memory": ("memory.max", "memory.limit_in_bytes"), "pids": ("pids.max", "pids.max")}

    def __init__(self, kind, limit):
        root = Path("/sys/fs/cgroup")
        version_2 = (root / "cgroup.controllers").exists()
        self.place = (root if version_2 else root / kind) / f"ricochet{os.getpid()}"
        try:
            self.place.mkdir()
            (self.place / self.FILES[kind][0 if version_2 else 1]).write_text(str(limit), encoding="ascii")
        except OSError as error:
            self.close()
            raise Skipped(f"no control group for {kind} can be made here: {error}") from error
        # Put before a command, these words run it in the group.
        self.prefix = ["/bin/sh", "-c", f'echo $$ > {self.place}/cgroup.procs; exec "$@"', "sh"]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        try:
            self.place.rmdir()
        except OSError:
            pass  # It was never made.


def wait_until(condition, seconds, step=0.05):
    """True as soon as the condition holds, false after this time."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        if condition():
            return True
        time.sleep(step)
    return bool(condition())


def cpu_until_idle(process, most_cpu_s, most_s=60):
    """CPU seconds that the process uses until none of its threads has wanted a processor for 0.3 s.

    None as soon as that is more than the limit: the machine may be busy, so that CPU time counts and not the clock.
    """
    before = process.cpu_s()
    deadline = time.monotonic() + most_s
    quiet_since, mark = time.monotonic(), before
    while process.cpu_s() - before <= most_cpu_s and time.monotonic() < deadline:
        if process.wants_processor() or process.cpu_s() - mark > 0.03:
            quiet_since, mark = time.monotonic(), process.cpu_s()
        elif time.monotonic() - quiet_since >= 0.3:
            return process.cpu_s() - before
        time.sleep(0.02)
    return None


def in_threads(functions):
    """Runs functions at once and returns their results in order; raises what one of them raised.

    The first one runs in the calling thread, and only it may start servers: a server dies with the thread that started it.
    """
    results = [None] * len(functions)
    errors = []

    def run(index, function):
        try:
            results[index] = function()
        except Exception as error:  # pylint: disable=broad-except  # Re-raised below.
            errors.append(error)

    threads = [threading.Thread(target=run, args=pair, daemon=True) for pair in enumerate(functions) if pair[0] > 0]
    for thread in threads:
        thread.start()
    run(0, functions[0])
    for thread in threads:
        thread.join()
    if errors:
        raise errors[0]
    return results


def percentile(values, part):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(part * len(ordered)))]


def remove(output):
    """Removes a file that the command line writes, and what an unfinished run has left of it."""
    for path in output.parent.glob(output.name + "*"):
        path.unlink()


def command_line(*arguments, timeout_s=60, **popen):
    """Runs `ricochet`; returns the finished process with its texts."""
    return subprocess.run([str(TOOLS.ricochet), *[str(a) for a in arguments]], capture_output=True, text=True,
                          timeout=timeout_s, check=False, stdin=subprocess.DEVNULL, **popen)


def _figures(figures):
    def show(value):
        if isinstance(value, float):
            return f"{value:.3g}"
        return str(value)

    return ", ".join(f"{name} {show(value)}" for name, value in (figures or {}).items())


def _run_rounds(one):
    """Returns the figures of the first round that is level; those of a round before it are printed."""
    for _ in range(TIMED_ROUNDS - 1 if one.timed else 0):
        try:
            return one.run()
        except NotLevel as reason:
            print(f"another round of {one.name}: {reason}", flush=True)
            _kill_live()
    return one.run()


def _kill_live():
    for process in list(_live):
        process.kill()


def run_check(one):
    start = time.monotonic()
    try:
        figures = _run_rounds(one)
        result, text = "level", _figures(figures)
    except Skipped as reason:
        figures, result, text = {}, "skipped", str(reason)
    except NotLevel as reason:
        figures, result, text = {}, "not level", str(reason)
    except Exception:  # pylint: disable=broad-except  # A check that breaks down is not level, and the others go on.
        figures, result, text = {}, "not level", traceback.format_exc(limit=-2).strip().replace("\n", " | ")
    _kill_live()
    seconds = time.monotonic() - start
    print(f"{result:9}  {one.name}  ({seconds:.1f} s)\n           {one.rule}\n           {text}", flush=True)
    return {"topic": Path(sys.argv[0]).stem, "name": one.name, "rule": one.rule, "kind": one.kind, "result": result,
            "text": text, "figures": figures or {}, "seconds": seconds, "mitigation": one.mitigation}


def main():
    global TOOLS  # pylint: disable=global-statement
    parser = argparse.ArgumentParser(description=sys.modules["__main__"].__doc__)
    parser.add_argument("--ricochetd", required=True)
    parser.add_argument("--ricochet", required=True)
    parser.add_argument("--proto", required=True)
    parser.add_argument("--work", required=True)
    parser.add_argument("--soak", action="store_true", help="the long run")
    parser.add_argument("--sanitized", action="store_true", help="the server was built with sanitizers, which take memory")
    parser.add_argument("--known", action="store_true", help="also the checks of what is known to lack a guard")
    parser.add_argument("--minutes", type=float, default=LONG_MINUTES, help="time of the mixed load in the long run")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="checks whose name matches this pattern")
    parser.add_argument("--without", default="", help="no checks whose name matches this pattern")
    parser.add_argument("--json", help="write the results to this file")
    arguments = parser.parse_args()
    TOOLS = Tools(arguments)
    TOOLS.prepare()
    # A topic may take functions from another one, whose checks are not its own. A name that is given is run however
    # long it takes.
    chosen = [
        one for one in CHECKS
        if one.run.__module__ == "__main__" and re.search(arguments.only, one.name) and not (arguments.without and re.search(arguments.without, one.name))
        and (arguments.soak or arguments.only or not one.soak)
        and (arguments.soak or arguments.only or arguments.known or not one.mitigation)]
    results = [run_check(one) for one in chosen]
    if arguments.json:
        Path(arguments.json).write_text(json.dumps(results, indent=1), encoding="utf-8")
    bad = [one["name"] for one in results if one["result"] == "not level" and not one["mitigation"]]
    print(f"{len(results)} checks, {len(bad)} not level{': ' if bad else ''}{', '.join(bad)}")
    sys.exit(1 if bad else 0)
