#!/bin/bash
# Hands to Slurm what is missing of this job. Run it again after a failure: nothing that is finished is done twice.
# What sbatch reads from the environment counts too: SBATCH_PARTITION and so on. Limits of memory (MiB) and time (minutes)
# come from a forecast where the environment has none; SBATCH_MEM_PER_NODE=0 is for nodes that do not state their memory.
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

# When all have ended, what died without coming back to the queue is handed over again.
id=$(sbatch "${options[@]}" --job-name="@NAME@-finish" --output=logs/finish.%j.log --dependency="afterany$after" \
  task.sh finish "${1:-1}")
echo "jobs${all//:/ } ${id%%;*}"
