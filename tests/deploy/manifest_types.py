"""Writes Kubernetes manifests as TypeScript, so that its compiler checks the types of all fields and finds unknown ones.

usage: manifest_types.py < MANIFESTS.yaml > MANIFESTS.ts

Types are those of the npm package kubernetes-types; the ServiceMonitor of the Prometheus operator has its own below.
"""
import json
import sys

import yaml

OPERATOR = """
interface ServiceMonitor {
  apiVersion: "monitoring.coreos.com/v1";
  kind: "ServiceMonitor";
  metadata: import("kubernetes-types/meta/v1").ObjectMeta;
  spec: {
    jobLabel?: string;
    selector: import("kubernetes-types/meta/v1").LabelSelector;
    endpoints: { port?: string; path?: string; interval?: string; scheme?: "http" | "https" }[];
  };
}
"""


def type_of(manifest):
    if manifest["kind"] == "ServiceMonitor":
        return "ServiceMonitor"
    version = manifest["apiVersion"].replace(".k8s.io", "")
    group = version if "/" in version else f"core/{version}"
    return f'import("kubernetes-types/{group}").{manifest["kind"]}'


manifests = [manifest for manifest in yaml.safe_load_all(sys.stdin) if manifest]
if not manifests:
    raise SystemExit("there is no manifest")
print(OPERATOR)
for number, manifest in enumerate(manifests):
    print(f"export const manifest{number}: {type_of(manifest)} = {json.dumps(manifest, indent=2)};\n")
