#!/bin/bash
# Many campaigns on a cluster: every task of the array runs one into a folder of its own, a last job compares all.
# A file lists the campaigns, one campaign.toml a line; the first is the reference of the comparison.
#
#   ls */campaign.toml > campaigns.txt
#   sbatch --array=1-$(wc -l < campaigns.txt) docs/slurm-campaigns.sh campaigns.txt results    # prints JOBID
#   sbatch --dependency=afterany:JOBID --export=ALL,COMPARE=1 docs/slurm-campaigns.sh campaigns.txt results
#
#SBATCH --job-name=impactid-campaigns
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=4
#SBATCH --time=01:00:00
#SBATCH --requeue
#SBATCH --output=campaigns-%j.log
set -euo pipefail

LIST=${1:?a file with one campaign.toml a line}
OUT=${2:?a folder for the results}
THREADS=${SLURM_CPUS_PER_TASK:-1}

# the folder of a campaign's results: its line in the list and the name of its own folder
folder() { printf '%s/%04d-%s' "$OUT" "$1" "$(basename "$(dirname "$(realpath -m "$2")")")"; }

mapfile -t CAMPAIGNS < "$LIST"

if [[ -n ${COMPARE:-} ]]; then
    done=()
    for i in "${!CAMPAIGNS[@]}"; do
        results=$(folder $((i + 1)) "${CAMPAIGNS[i]}")
        if [[ -s $results/identification.json ]]; then
            done+=("$results")
        elif ((i == 0)); then
            echo "${CAMPAIGNS[i]}, the reference, has no results" >&2
            exit 2
        else
            echo "${CAMPAIGNS[i]} has no results and is left out" >&2
        fi
    done
    exec impactid --threads "$THREADS" compare "${done[@]}" --out "$OUT/comparison"
fi

CAMPAIGN=${CAMPAIGNS[SLURM_ARRAY_TASK_ID - 1]:?the list has no such line}
# a task that was put back into the queue goes on; a model that does not fit (1) is an answer too
code=0
impactid --threads "$THREADS" run "$CAMPAIGN" --resume --out "$(folder "$SLURM_ARRAY_TASK_ID" "$CAMPAIGN")" || code=$?
exit $((code == 1 ? 0 : code))
