"""Holds the manifests in deploy/kubernetes to each other, to the flags of the programs and to the rules of a careful cluster.

usage: manifests_test.py SOURCE_DIRECTORY RICOCHETD RICOCHET
"""
import functools
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import yaml

RICOCHET, RICOCHETD, SOURCE = [pathlib.Path(sys.argv.pop()).resolve() for _ in range(3)]
KUBERNETES = SOURCE / "deploy/kubernetes"
MANIFESTS = {path.relative_to(KUBERNETES).as_posix(): yaml.safe_load(path.read_text())
             for path in sorted(KUBERNETES.rglob("*.yaml"))}


def base(name):
    return MANIFESTS[f"base/{name}.yaml"]


def pods():
    for name in ("base/deployment.yaml", "sweep/job.yaml", "sweep/merge.yaml"):
        yield name, MANIFESTS[name]["spec"]["template"]["spec"]


@functools.cache
def flags_of(*command):
    done = subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE, timeout=60)
    return set(re.findall(r"--[a-z-]+", done.stdout))


def seconds(flag):
    """The default of a flag of ricochetd that is a time."""
    text = subprocess.run([RICOCHETD, "--help"], check=True, text=True, stdout=subprocess.PIPE, timeout=60).stdout
    return float(re.search(rf"{flag} SECONDS[^\[]*\[([0-9.]+)\]", text).group(1))


class ManifestsTest(unittest.TestCase):
    def test_every_file_is_in_a_kustomization_or_applied_by_its_name(self):
        for folder in ("base", "tls", "sweep"):
            kustomization = MANIFESTS[f"{folder}/kustomization.yaml"]
            named = [*kustomization["resources"], *(patch["path"] for patch in kustomization.get("patches", []))]
            for entry in named:
                self.assertTrue((KUBERNETES / folder / entry).exists(), f"{folder}/kustomization.yaml names {entry}")
            text = (KUBERNETES / folder / "kustomization.yaml").read_text()
            for path in (KUBERNETES / folder).iterdir():
                self.assertTrue(path.name == "kustomization.yaml" or path.name in text, path)

    def test_selectors_find_the_pods(self):
        labels = base("deployment")["spec"]["template"]["metadata"]["labels"]
        selectors = [
            base("deployment")["spec"]["selector"]["matchLabels"], base("service")["spec"]["selector"],
            base("pdb")["spec"]["selector"]["matchLabels"], base("networkpolicy")["spec"]["podSelector"]["matchLabels"],
            *(spread["labelSelector"]["matchLabels"]
              for spread in base("deployment")["spec"]["template"]["spec"]["topologySpreadConstraints"])]
        for selector in selectors:
            self.assertLessEqual(selector.items(), labels.items())
        monitor = base("servicemonitor")["spec"]
        self.assertLessEqual(monitor["selector"]["matchLabels"].items(), base("service")["metadata"]["labels"].items())
        self.assertEqual(base("hpa")["spec"]["scaleTargetRef"],
                         {key: base("deployment")[key] for key in ("apiVersion", "kind")} | {"name": "ricochet"})
        # The alert rules are for the job ricochet, which the label names.
        self.assertEqual(base("service")["metadata"]["labels"][monitor["jobLabel"]], "ricochet")

    def test_ports_have_one_number_and_one_name_everywhere(self):
        (container,) = base("deployment")["spec"]["template"]["spec"]["containers"]
        ports = {port["name"]: port["containerPort"] for port in container["ports"]}
        arguments = dict(argument[2:].split("=") for argument in container["args"] if "=" in argument)
        self.assertEqual(ports, {"grpc": int(arguments["listen"].split(":")[1]),
                                 "metrics": int(arguments["metrics"].split(":")[1])})
        self.assertEqual({port["targetPort"]: port["port"] for port in base("service")["spec"]["ports"]}, ports)
        for probe in ("startupProbe", "readinessProbe", "livenessProbe"):
            self.assertEqual(container[probe]["grpc"]["port"], ports["grpc"])
        rules = base("networkpolicy")["spec"]["ingress"]
        self.assertEqual({port["port"] for rule in rules for port in rule["ports"]}, set(ports))
        self.assertEqual([endpoint["port"] for endpoint in base("servicemonitor")["spec"]["endpoints"]], ["metrics"])

    def test_every_flag_exists(self):
        (container,) = base("deployment")["spec"]["template"]["spec"]["containers"]
        tls = [patch["value"] for patch in MANIFESTS["tls/arguments.yaml"]]
        for argument in [*container["args"], *tls]:
            self.assertIn(argument.split("=")[0], flags_of(RICOCHETD, "--help"))
        for name in ("job", "merge"):
            (container,) = MANIFESTS[f"sweep/{name}.yaml"]["spec"]["template"]["spec"]["containers"]
            flags = {argument.split("=")[0] for argument in container["args"] if argument.startswith("--")}
            self.assertLessEqual(flags, flags_of(RICOCHET, container["args"][0], "--help"))

    def test_the_grace_of_a_pod_holds_its_drain(self):
        spec = base("deployment")["spec"]["template"]["spec"]
        (container,) = spec["containers"]
        sleep = int(container["lifecycle"]["preStop"]["exec"]["command"][1])
        needed = sleep + seconds("--drain-grace") + seconds("--drain-timeout")
        self.assertGreaterEqual(spec["terminationGracePeriodSeconds"], 2 * needed)
        # A drain must not look like a death to the kubelet.
        liveness = container["livenessProbe"]
        self.assertGreater(liveness["periodSeconds"] * liveness["failureThreshold"], spec["terminationGracePeriodSeconds"])

    def test_the_server_computes_with_the_cores_it_may_use(self):
        (container,) = base("deployment")["spec"]["template"]["spec"]["containers"]
        self.assertIn(f"--compute-threads={container['resources']['limits']['cpu']}", container["args"])

    def test_pods_run_without_rights(self):
        for name, spec in pods():
            self.assertFalse(spec["automountServiceAccountToken"], name)
            self.assertTrue(spec["securityContext"]["runAsNonRoot"], name)
            self.assertEqual(spec["securityContext"]["seccompProfile"], {"type": "RuntimeDefault"}, name)
            user = re.search(r"^USER (\d+):", (SOURCE / "deploy/Dockerfile").read_text(), re.MULTILINE).group(1)
            self.assertEqual(spec["securityContext"]["runAsUser"], int(user), name)
            for container in spec["containers"]:
                self.assertEqual(container["securityContext"], {
                    "allowPrivilegeEscalation": False, "readOnlyRootFilesystem": True, "capabilities": {"drop": ["ALL"]}})
                self.assertEqual(set(container["resources"]["limits"]), {"cpu", "memory"}, name)
                self.assertEqual(set(container["resources"]["requests"]), {"cpu", "memory"}, name)

    def test_the_job_has_as_many_pods_as_shards(self):
        job = MANIFESTS["sweep/job.yaml"]["spec"]
        (container,) = job["template"]["spec"]["containers"]
        self.assertEqual(job["completionMode"], "Indexed")
        self.assertIn(f"--shard-count={job['completions']}", container["args"])
        (merge,) = MANIFESTS["sweep/merge.yaml"]["spec"]["template"]["spec"]["containers"]
        (output,) = [argument for argument in container["args"] if argument.startswith("--output=")]
        self.assertEqual(merge["args"][-1], output.removeprefix("--output="))

    def test_a_pod_of_the_job_computes_without_the_server_of_the_image(self):
        (container,) = MANIFESTS["sweep/job.yaml"]["spec"]["template"]["spec"]["containers"]
        with tempfile.TemporaryDirectory() as results:
            arguments = [argument.replace("/results", results) for argument in container["args"]]
            environment = {"PATH": f"{RICOCHET.parent}:/usr/bin:/bin", "RICOCHET_SERVER": "127.0.0.1:1",
                           "JOB_COMPLETION_INDEX": "0"}
            subprocess.run([*container["command"], *arguments], check=True, env=environment, timeout=60)

    def test_tls_asks_by_the_command_line(self):
        spec = MANIFESTS["tls/deployment.yaml"]["spec"]["template"]["spec"]
        (container,) = spec["containers"]
        for probe in ("startupProbe", "readinessProbe", "livenessProbe"):
            self.assertIsNone(container[probe]["grpc"])
            self.assertEqual(container[probe]["exec"]["command"], ["ricochet", "health"])
        (mount,) = container["volumeMounts"]
        files = [entry["value"] for entry in container["env"] if entry["name"].startswith("RICOCHET_TLS")]
        files += [patch["value"].split("=")[1] for patch in MANIFESTS["tls/arguments.yaml"]]
        for file in files:
            self.assertEqual(str(pathlib.PurePosixPath(file).parent), mount["mountPath"])


if __name__ == "__main__":
    unittest.main()
