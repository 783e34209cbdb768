#!/usr/bin/env bash
# Clients of other makers ask a real server by reflection alone: buf curl, which stands for grpcurl, and grpc-js.
# usage: clients_test.sh RICOCHETD WORK_DIRECTORY, after "npm install" there
set -euo pipefail
readonly ricochetd=$1 work=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
readonly here
export PATH=$work/node_modules/.bin:$PATH

fail() {
  printf 'clients_test: %s\n' "$*" >&2
  exit 1
}

rm -f "$work/port"
"$ricochetd" --listen 127.0.0.1:0 --reflection 127.0.0.1:0 --port-file "$work/port" --drain-grace 0 \
  2>"$work/server.log" &
server_pid=$!
trap 'kill "$server_pid" 2>/dev/null || true' EXIT
for _ in {1..100}; do
  [[ ! -s $work/port ]] || break
  kill -0 "$server_pid" || fail "$(<"$work/server.log")"
  sleep 0.1
done
address=127.0.0.1:$(<"$work/port")
reflection=$(sed -n 's/^.* reflection address=//p' "$work/server.log")

buf=(buf curl --http2-prior-knowledge --protocol grpc)
methods=$("${buf[@]}" --list-methods "http://$reflection")
for method in grpc.health.v1.Health/Check grpc.reflection.v1.ServerReflection/ServerReflectionInfo \
  ricochet.v1.ImpactService/Solve ricochet.v1.ImpactService/Sweep; do
  grep -qx "$method" <<<"$methods" || fail "buf curl --list-methods does not show $method"
done
for version in grpc-v1 grpc-v1alpha; do
  "${buf[@]}" --reflect-protocol "$version" --list-services "http://$reflection" | grep -qx ricochet.v1.ImpactService ||
    fail "buf curl cannot list the services by $version"
done
status=$("${buf[@]}" --data '{}' "http://$reflection/grpc.health.v1.Health/Check")
[[ $status == *SERVING* ]] || fail "buf curl says of health: $status"
echo "buf curl, by reflection: lists every method and asks for health"

ln -sf "$here/reflection.js" "$work/reflection.js"
NODE_PATH=$work/node_modules node --preserve-symlinks-main "$work/reflection.js" "$address" "$reflection"
kill "$server_pid"
wait "$server_pid" || fail "ricochetd ended with $?"
