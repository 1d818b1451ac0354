#!/bin/bash
# A fine atlas on a cluster: every task of the array computes one part, a last job merges them.
#
#   sbatch docs/slurm-atlas.sh                      # the parts
#   sbatch --dependency=afterok:JOBID --array=0 --export=ALL,MERGE=1 docs/slurm-atlas.sh
#
#SBATCH --job-name=impactid-atlas
#SBATCH --array=0-63
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=8
#SBATCH --time=01:00:00
#SBATCH --output=atlas-%A-%a.log
set -euo pipefail

PARTS=64
OUT=${OUT:-$PWD/atlas}
# one instruction set for all machines, so that every part rounds alike
ATLAS=(--restitution 0.9 --damping-ratio 0.07 --eta 0.3..5 --rho=-1.2..8
       --columns 4000 --rows 3200 --largest-p 4 --largest-n 6 --kernel avx2)

if [[ -n ${MERGE:-} ]]; then
    exec impactid --threads "$SLURM_CPUS_PER_TASK" merge "$OUT"/parts/part-*-of-$PARTS.json --out "$OUT"
fi
exec impactid --threads "$SLURM_CPUS_PER_TASK" \
    atlas "${ATLAS[@]}" --shard "$SLURM_ARRAY_TASK_ID/$PARTS" --out "$OUT/parts"
