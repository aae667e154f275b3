#!/bin/bash
# One task: task.sh STEP FIRST, number FIRST + SLURM_ARRAY_TASK_ID of the step. It may be killed and started again at
# any moment.
tyndall=${TYNDALL:-@PROGRAM@}
chunks=(@CHUNKS@)
parts=@PARTS@
number=$(($2 + ${SLURM_ARRAY_TASK_ID:-0}))

# Runs the program. SIGTERM goes on to it: it writes a checkpoint, and the task goes back to the queue unless the job was
# cancelled. A program that is killed starts again here, from its checkpoint, four times at most.
run() {
  local program code tries job=${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID
  for ((tries = 0; tries < 5; ++tries)); do
    "$tyndall" "$@" --threads "${SLURM_CPUS_PER_TASK:-1}" &
    program=$!
    trap 'kill -TERM "$program"' TERM
    wait "$program" && code=0 || code=$?
    while kill -0 "$program" 2>/dev/null; do # a signal ended the waiting, not the program
      wait "$program" && code=0 || code=$?
    done
    ((code == 137)) || break
  done
  if ((code == 143 && ${SLURM_RESTART_COUNT:-0} < 100)) && [ "$(squeue -h -j "$job" -o %T)" = RUNNING ]; then
    scontrol requeue "$job"
  fi
  exit "$code"
}

case $1 in
@PLAN@
parts)
  frames=${chunks[number / parts]} part=$((number % parts + 1))
  run @RENDER@ ;;
merge)
  frames=${chunks[number]}
  run @MERGE@ ;;
finish) # submits again what is missing, at most twice
  "$tyndall" status . && exit 0
  [ "$2" -lt 3 ] && exec bash ./submit.sh $(($2 + 1))
  exit 1 ;;
esac
