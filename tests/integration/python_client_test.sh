#!/usr/bin/env bash
# A Python program asks a real server, with stubs made by protoc as for any other language.
# usage: python_client_test.sh PROTO_DIRECTORY RICOCHETD WORK_DIRECTORY
set -euo pipefail
readonly proto=$1 ricochetd=$2 work=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
readonly here

rm -rf "$work"
mkdir -p "$work/stubs"
protoc -I "$proto" --python_out="$work/stubs" "$proto"/ricochet/v1/*.proto "$proto"/google/rpc/*.proto
protoc -I "$proto" --grpc_out="$work/stubs" --plugin=protoc-gen-grpc="$(command -v grpc_python_plugin)" \
  "$proto/ricochet/v1/impact_service.proto"

"$ricochetd" --listen 127.0.0.1:0 --port-file "$work/port" --drain-grace 0 >"$work/server.log" 2>&1 &
server_pid=$!
trap 'kill "$server_pid" 2>/dev/null || true' EXIT
for _ in {1..100}; do
  [[ ! -s $work/port ]] || break
  kill -0 "$server_pid" || { cat "$work/server.log"; exit 1; }
  sleep 0.1
done

PYTHONPATH=$work/stubs /usr/bin/python3 "$here/python_client_test.py" "127.0.0.1:$(<"$work/port")"

kill "$server_pid"
wait "$server_pid"
