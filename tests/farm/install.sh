#!/usr/bin/env bash
# Installs the engines that tests/farm runs jobs on: Debian's Slurm, whose services stay off, and openjd-cli in
# build/openjd.
set -euo pipefail
cd "$(dirname "$0")/../.."
root=()
[ "$(id -u)" -eq 0 ] || root=(sudo -n)
"${root[@]}" apt-get install -y -q --no-install-recommends slurmctld slurmd slurm-client python3-venv
[ -x build/openjd/bin/openjd ] || { /usr/bin/python3 -m venv build/openjd && build/openjd/bin/pip install -q openjd-cli==0.8.0; }
