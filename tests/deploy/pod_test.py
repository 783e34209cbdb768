"""Plays the Deployment of deploy/kubernetes/base by podman, asks its pod, and stops it.

usage: pod_test.py MANIFEST RICOCHET WORK_DIRECTORY RICOCHET_IMAGE

MANIFEST is what `kubectl kustomize deploy/kubernetes/base` prints. The pod is as in the manifest but for the name of the
image. podman neither asks the gRPC probes nor runs preStop, so this test asks for health itself.
"""
import pathlib
import subprocess
import sys
import urllib.request

import yaml

from containers import environment, is_serving, wait_for

MANIFEST, RICOCHET, WORK = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
IMAGE = sys.argv[4]
SERVER = "127.0.0.1:50051"
POD = "ricochet-pod-0"
CONTAINER = f"{POD}-ricochetd"
NEWTON = "0.707107"
PROMISES = {
    "{{.HostConfig.ReadonlyRootfs}}": "true", "{{.HostConfig.Memory}}": str(1 << 30),
    "{{.HostConfig.NanoCpus}}": "2000000000", "{{.Config.User}}": "10001:10001", "{{.EffectiveCaps}}": "[]"}


def run(*command, **options):
    return subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE, timeout=120, **options).stdout


def expect(found, expected, what):
    if found != expected:
        raise SystemExit(f"{what}: {found!r}, not {expected!r}")


def play(env):
    run("podman", "play", "kube", WORK / "pod.yaml", env=env)
    wait_for("server in the pod", lambda: is_serving(RICOCHET, SERVER), 60)
    print("the pod of the Deployment serves", flush=True)
    answer = run(RICOCHET, "solve", "--a", "0.3", "--b", "1", "--mu", "0.1", "--energetic", "1", "--server", SERVER)
    if NEWTON not in answer:
        raise SystemExit(f"the answer is not {NEWTON}:\n{answer}")
    with urllib.request.urlopen("http://127.0.0.1:9464/metrics", timeout=10) as page:
        expect("\nricochet_serving 1\n" in page.read().decode(), True, "ricochet_serving is 1")
    for what, promised in PROMISES.items():
        expect(run("podman", "inspect", "--format", what, CONTAINER, env=env).strip(), promised, what)
    print("it answers, has metrics, a read-only file system, its limits and no capability", flush=True)
    run("podman", "pod", "stop", "--time", "20", POD, env=env)
    expect(run("podman", "inspect", "--format", "{{.State.ExitCode}}", CONTAINER, env=env).strip(), "0", "exit code")
    print("it drained and ended with 0", flush=True)


def main():
    env = environment(WORK)
    [deployment] = [part for part in yaml.safe_load_all(MANIFEST.read_text()) if part["kind"] == "Deployment"]
    deployment["spec"]["template"]["spec"]["containers"][0]["image"] = IMAGE
    (WORK / "pod.yaml").write_text(yaml.safe_dump(deployment))
    try:
        play(env)
    finally:
        subprocess.run(["podman", "play", "kube", "--down", WORK / "pod.yaml"], env=env, check=False,
                       stdout=subprocess.DEVNULL, timeout=120)


main()
