#!/bin/sh
# make-user: makes the system user that the units run nodes as, unless there is
# one, and puts him into the groups that cameras, serial ports, GPUs and buses of
# this host belong to. Who is in the group roscell may command its nodes.
set -eu
if ! getent passwd roscell > /dev/null; then
  adduser --quiet --system --group --home /var/lib/roscell --no-create-home \
    --gecos 'ROSCell node' roscell
fi
for group in audio dialout gpio i2c input plugdev render spi video; do
  ! getent group "$group" > /dev/null || adduser --quiet roscell "$group"
done
