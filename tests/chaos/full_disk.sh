#!/bin/sh
# full_disk.sh FOLDER KILOBYTES PYTHON TASK [FLAG...]: runs `rtg` on a disk of that size, on which it must fail with status
# 1, and again with --resume once there is room. Leaves its transitions in FOLDER. In a mount namespace of its own.
folder=$1
size=$2
python=$3
shift 3
mkdir "$folder/disk" && mount -t tmpfs -o size="${size}k" none "$folder/disk" || exit 3
"$python" -m rtg.cli "$@" --out "$folder/disk/run" 2>&1
[ $? = 1 ] || exit 4
mount -o remount,size=1g "$folder/disk" || exit 3
"$python" -m rtg.cli --resume --out "$folder/disk/run" 2>&1 || exit 5
mv "$folder/disk/run/transitions.npz" "$folder"
