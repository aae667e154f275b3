#!/bin/bash
# Submits to Slurm what this job still lacks. Run it again after a failure: finished tasks are not repeated.
# The environment variables of sbatch apply too: SBATCH_PARTITION and so on. Limits of memory (MiB) and time (minutes)
# come from a forecast unless the environment sets them; SBATCH_MEM_PER_NODE=0 is for nodes that do not state their memory.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
tyndall=${TYNDALL:-@PROGRAM@}
@LIMITS@
options=(@OPTIONS@ --chdir="$PWD")

# Each step waits for the end, good or bad, of the one before. No array has an index above 1000.
all= after=
for step in @STEPS@; do
  arrays=$("$tyndall" status . --tasks "$step")
  [ -n "$arrays" ] || continue
  ids=
  while read -r first list; do
    id=$(sbatch "${options[@]}" --job-name="@NAME@-$step" --output="logs/$step.%A_%a.log" --array="$list" \
      ${after:+--dependency=afterany$after} task.sh "$step" "$first")
    ids+=:${id%%;*}
  done <<<"$arrays"
  after=$ids all+=$ids
done
[ -n "$after" ] || { echo "nothing is missing"; exit 0; }

# When all have ended, tasks that died without returning to the queue are submitted again.
id=$(sbatch "${options[@]}" --job-name="@NAME@-finish" --output=logs/finish.%j.log --dependency="afterany$after" \
  task.sh finish "${1:-1}")
echo "jobs${all//:/ } ${id%%;*}"
