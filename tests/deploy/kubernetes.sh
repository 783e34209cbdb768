#!/usr/bin/env bash
# ./dev kubernetes: the manifests, the types of their fields, and the pod of the Deployment.
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/dev_lib.sh"

require_root kubernetes "it runs a pod without a daemon"
install_missing "${build_packages[@]}" "${image_packages[@]}" python3 python3-yaml
command -v kubectl >/dev/null || die "kubernetes needs kubectl, which Debian 12 has only in a version without kustomize"
command -v npm >/dev/null || die "kubernetes needs npm, for TypeScript and the types of Kubernetes' resources"
mkdir -p build/kubernetes
cp tests/deploy/package.json build/kubernetes/
npm install --prefix build/kubernetes --silent --no-audit --no-fund
say "Kustomizations, and the types of all their fields"
tsc=(build/kubernetes/node_modules/.bin/tsc --noEmit --strict)
for name in base tls sweep; do
  show_only kubectl kustomize "deploy/kubernetes/$name"
  kubectl kustomize "deploy/kubernetes/$name" >"build/kubernetes/$name.yaml"
  /usr/bin/python3 tests/deploy/manifest_types.py <"build/kubernetes/$name.yaml" >"build/kubernetes/$name.ts"
done
/usr/bin/python3 tests/deploy/manifest_types.py <deploy/kubernetes/sweep/merge.yaml >build/kubernetes/merge.ts
show "${tsc[@]}" build/kubernetes/{base,tls,sweep,merge}.ts
# A field that does not exist must be found, or the types check nothing.
sed 's/"replicas"\|"periodSeconds"/"misspelt"/' build/kubernetes/base.ts >build/kubernetes/misspelt.ts
! "${tsc[@]}" build/kubernetes/misspelt.ts >/dev/null || die "a misspelt field was not found"
echo "-> every field exists and has its type; a misspelt one was found"
build_release
buildah inspect --type image "$image" &>/dev/null || tests/deploy/image.sh
say "The pod of the Deployment, played by podman"
show /usr/bin/python3 tests/deploy/pod_test.py build/kubernetes/base.yaml "$ricochet" build/kubernetes/pod "$image"
