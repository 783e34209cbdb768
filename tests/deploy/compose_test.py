"""Brings up deploy/pool/compose.yaml, kills a server under a sweep, and asks Prometheus what it has seen.

usage: compose_test.py SOURCE_DIRECTORY RICOCHET WORK_DIRECTORY RICOCHET_IMAGE

HAProxy and Prometheus come from images that are made of Debian's packages, so no registry is needed.
"""
import json
import pathlib
import signal
import subprocess
import sys
import urllib.parse
import urllib.request

from containers import environment, is_serving, wait_for

SOURCE, RICOCHET, WORK = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
IMAGE = sys.argv[4]
PROGRAMS = {"HAPROXY_IMAGE": "haproxy", "PROMETHEUS_IMAGE": "prometheus"}
SERVERS = ["one", "two", "three"]
# An impact that takes time costs a millisecond, so that Prometheus, which reads every 15 s, sees who computes the
# sweep.
SWEEP = ["sweep", "--scene", SOURCE / "tests/data/scenes/dropped_rod.textproto", "--axis",
         "friction.kinetic_coefficient=lin:0.01:1.5:60000", "--column", "coefficients.newton", "--format", "npy"]


def run(*command, **options):
    return subprocess.run(command, check=True, text=True, timeout=600, **options)


def query(expression):
    """The values that Prometheus finds, by the name of the server."""
    url = "http://127.0.0.1:9090/api/v1/query?" + urllib.parse.urlencode({"query": expression})
    with urllib.request.urlopen(url, timeout=10) as reply:
        found = json.load(reply)["data"]["result"]
    return {one["metric"]["instance"].split(":")[0]: float(one["value"][1]) for one in found}


def exit_code(name, env):
    """Stops a container and returns how its process ended."""
    run("podman", "stop", "--time", "20", f"ricochet-test_{name}_1", env=env, stdout=subprocess.DEVNULL)
    return int(run("podman", "inspect", "--format", "{{.State.ExitCode}}", f"ricochet-test_{name}_1", env=env,
                   stdout=subprocess.PIPE).stdout)


def serving():
    return is_serving(RICOCHET, "127.0.0.1:50051")


def main():
    env = {**environment(WORK), "RICOCHET_IMAGE": IMAGE}
    for variable, package in PROGRAMS.items():
        env[variable] = f"localhost/ricochet-{package}:dev"
        run("buildah", "bud", "--pull-never", "--layers", "--format", "docker", "--isolation", "chroot", "--quiet",
            "--build-arg", f"PACKAGE={package}", "--file", SOURCE / "tests/deploy/program.Dockerfile", "--tag", env[variable],
            WORK, stdout=subprocess.DEVNULL)
    compose = ["podman-compose", "--project-name", "ricochet-test", "--file", str(SOURCE / "deploy/pool/compose.yaml")]
    run(RICOCHET, *SWEEP, "-o", WORK / "whole.npy")
    try:
        run(*compose, "up", "--detach", env=env)
        wait_for("server behind HAProxy", serving)
        wait_for("three servers that Prometheus reads",
                 lambda: query('up{job="ricochet"} == 1') == dict.fromkeys(SERVERS, 1))
        print("three servers serve behind HAProxy, and Prometheus reads all of them", flush=True)
        sweep = subprocess.Popen([RICOCHET, *SWEEP, "--server", "127.0.0.1:50051", "-o", WORK / "sweep.npy"])
        killed = next(iter(wait_for("server with a live call", lambda: query("ricochet_live_calls > 0"))))
        drained = next(name for name in SERVERS if name != killed)
        run("podman", "kill", "--signal", "KILL", f"ricochet-test_{killed}_1", env=env, stdout=subprocess.DEVNULL)
        if sweep.poll() is not None:
            raise SystemExit("the sweep ended before its server was killed")
        code = sweep.wait(300)
        while code == 75:
            code = subprocess.run([RICOCHET, *SWEEP, "--server", "127.0.0.1:50051", "-o", WORK / "sweep.npy", "--resume"],
                                  check=False, timeout=300).returncode
        if code != 0 or (WORK / "sweep.npy").read_bytes() != (WORK / "whole.npy").read_bytes():
            raise SystemExit(f"the sweep ended with {code}, or differs from that of the embedded engine")
        print(f"{killed} was killed under a sweep, which ended with the bytes of the embedded engine", flush=True)
        # A container that has been killed stays down until somebody starts it.
        wait_for("alarm for the server that is gone", lambda: query('up{job="ricochet"} == 0') == {killed: 0})
        print(f"Prometheus sees that {killed} is down", flush=True)
        code = exit_code(drained, env)
        if code != 0 or not serving():
            raise SystemExit(f"the drained server ended with {code}, or the last one does not serve")
        print(f"{drained} drained and ended with 0, and the last one serves alone", flush=True)
        code = exit_code("haproxy", env)
        if code == 128 + signal.SIGKILL:
            raise SystemExit("HAProxy did not end by itself within 20 s")
        print(f"HAProxy ended by itself, with {code}", flush=True)
    finally:
        subprocess.run([*compose, "down", "--timeout", "20"], env=env, check=False, stdout=subprocess.DEVNULL, timeout=300)


main()
