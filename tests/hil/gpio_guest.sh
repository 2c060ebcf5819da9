#!/bin/bash
# Runs inside the loop's kernel (toolchain/hil/run tests/hil/gpio_guest.sh PROGRAM [ARGUMENTS]): makes the simulated
# gpiochip "stiction-test" of 16 lines and a second one of 4, and runs the test program with its arguments there.
# Exits with the program's status.
set -eu
mounted() { grep -q " $1 " /proc/mounts; }
[ -e /proc/mounts ] || mount -t proc none /proc
mounted /sys || mount -t sysfs none /sys
mounted /sys/kernel/config || mount -t configfs none /sys/kernel/config
[ -n "${TMPDIR:-}" ] || { mounted /tmp || mount -t tmpfs none /tmp; }

# make_chip LABEL LINES
make_chip() {
  local chip=/sys/kernel/config/gpio-sim/$1
  mkdir "$chip" "$chip/bank0"
  echo "$2" >"$chip/bank0/num_lines"
  echo "$1" >"$chip/bank0/label"
  echo 1 >"$chip/live"
}
make_chip stiction-test 16
make_chip stiction-other 4

status=0
TMPDIR=${TMPDIR:-/tmp} "$@" || status=$?
for chip in stiction-test stiction-other; do
  echo 0 >/sys/kernel/config/gpio-sim/$chip/live
  rmdir /sys/kernel/config/gpio-sim/$chip/bank0 /sys/kernel/config/gpio-sim/$chip
done
exit $status
