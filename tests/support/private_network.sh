#!/bin/sh
# private_network.sh COMMAND...: runs it in a network of its own, loopback with multicast, where tests may send and
# break what they like. Exit code 77 (skipped) where the machine forbids such networks.
if ! unshare --map-root-user --net true; then
  echo "private_network.sh: this machine forbids network namespaces" >&2
  exit 77
fi
PATH=$PATH:/usr/sbin:/sbin # ip and tc
exec unshare --map-root-user --net sh -c '
  ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo && RTG_PRIVATE_NETWORK=1 exec "$@"' sh "$@"
