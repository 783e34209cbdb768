#!/bin/bash
# with_server.sh RICOCHETD FOLDER PROGRAM: runs the program with the address of a server that lives as long as it.
set -euo pipefail
readonly port_file=$2/server.port
rm -f "$port_file"
"$1" --listen 127.0.0.1:0 --port-file "$port_file" 2>"$2/server.log" &
server=$!
trap 'kill "$server"; wait "$server" || true' EXIT
for _ in {1..300}; do
  [[ -s $port_file ]] && break
  sleep 0.1
done
"$3" "127.0.0.1:$(<"$port_file")"
