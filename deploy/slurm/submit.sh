#!/bin/sh
# Submits one sweep to Slurm: an array with a task for each shard, and a merge that starts once all of them are done.
#
# usage: submit.sh FILE SHARDS SWEEP-ARGUMENT...
#   FILE, in a directory that all nodes share, is what the merge writes. Its ending .csv, .json, .jsonl, .npy or .nc is
#   the format.
#   RICOCHET names the program if it is not in the PATH of the nodes. SBATCH_* variables go to sbatch:
#   SBATCH_PARTITION=...
#
# Slurm starts the tasks of a node that has died again on another one, and each goes on from its last half second.
# Whatever else ends a task, submit the same line again: shards that are complete are not computed anew.
set -eu

if [ $# -lt 3 ]; then
  sed -n '/^# usage:/,/^#$/s/^# //p' "$0" >&2
  exit 2
fi
case $2 in
  '' | 0* | *[!0-9]*)
    echo "submit.sh: SHARDS = $2: must be an integer from 1 on" >&2
    exit 2
    ;;
esac
case $1 in
  *.csv | *.json | *.jsonl | *.npy | *.nc) ;;
  *)
    echo "submit.sh: FILE = $1: must end in .csv, .json, .jsonl, .npy or .nc" >&2
    exit 2
    ;;
esac
for argument in "$@"; do
  case $argument in
    --threads | --threads=* | --shard* | -o | --output | --output=*)
      echo "submit.sh: $argument: must not be given, because the array sets it" >&2
      exit 2
      ;;
  esac
done
here=$(cd "$(dirname "$0")" && pwd)
file=$1
shards=$2
shift 2

array=$(sbatch --parsable --array="0-$((shards - 1))" --requeue "$here/shard.sbatch" "$file" "$shards" "$@")
merge=$(sbatch --parsable --dependency="afterok:$array" --kill-on-invalid-dep=yes "$here/merge.sbatch" "$file")
echo "array $array, then merge $merge"
