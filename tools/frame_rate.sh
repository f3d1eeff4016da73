#!/usr/bin/env bash
# How many frames a second the viewer's window makes, in a virtual display, by parts: 300 boxes that bounce in a pit, at
# 1280x720. Needs Xvfb, and Mesa's software Vulkan where there is no graphics card.
#
#   cargo build --release -p ferrode-view && tools/frame_rate.sh [FRAMES] [options of `ferrode-view view`]
#   VIEWER=path/to/ferrode-view tools/frame_rate.sh
set -euo pipefail
cd "$(dirname "$0")/.."
viewer=${VIEWER:-${CARGO_TARGET_DIR:-target}/release/ferrode-view}
frames=${1:-200}
shift || true
folder=$(mktemp -d)
trap 'kill "${server:-}" 2>/dev/null || true; rm -rf "$folder"' EXIT

# Boxes of two sizes in a spiral above the pit; its walls keep nearly all in. Nothing rubs, every bounce gives back what it took, so that
# all go on moving.
awk 'BEGIN {
  print "<sdf version=\"1.10\"><world name=\"pit\"><gravity>0 0 -2</gravity>"
  print "<physics type=\"ode\"><max_step_size>0.01</max_step_size><ode><solver><type>quick</type></solver></ode></physics>"
  print "<model name=\"pit\"><static>true</static><link name=\"l\">"
  surface = "<surface><friction><ode><mu>0</mu><mu2>0</mu2></ode></friction>"
  surface = surface "<bounce><restitution_coefficient>1</restitution_coefficient><threshold>0.01</threshold></bounce></surface>"
  print "<collision name=\"floor\"><geometry><plane><normal>0 0 1</normal></plane></geometry>" surface "</collision>"
  for (i = 0; i < 4; i++) {
    x = (i == 0) * 3.1 - (i == 1) * 3.1; y = (i == 2) * 3.1 - (i == 3) * 3.1
    sides = i < 2 ? "0.2 6.4 2" : "6.4 0.2 2"
    printf "<collision name=\"wall%d\"><pose>%g %g 1 0 0 0</pose><geometry><box><size>%s</size></box></geometry>%s</collision>\n", i, x, y, sides, surface
  }
  print "</link></model>"
  for (n = 0; n < 300; n++) {
    a = n * 2.399963; r = 2.6 * sqrt((n % 50 + 0.5) / 50); z = 0.4 + 0.45 * int(n / 50)
    s = n % 3 ? 0.3 : 0.4
    printf "<model name=\"b%d\"><pose>%g %g %g %g %g 0</pose><link name=\"l\"><inertial auto=\"true\"><density>300</density></inertial>", n, r * cos(a), r * sin(a), z, n * 0.7, n * 1.3
    printf "<collision name=\"c\"><geometry><box><size>%g %g %g</size></box></geometry>%s</collision></link></model>\n", s, s, s, surface
  }
  print "</world></sdf>"
}' > "$folder/pit.sdf"

Xvfb -displayfd 3 -noreset -nolisten tcp -screen 0 1280x720x24 3> "$folder/display" 2> /dev/null &
server=$!
until [ -s "$folder/display" ]; do sleep 0.1; kill -0 "$server"; done
used() { awk '{ sub(/.*\) /, ""); print $12 + $13 }' "/proc/$server/stat"; }
before=$(used)
DISPLAY=:$(cat "$folder/display") "$viewer" view "$folder/pit.sdf" --size 1280x720 --camera -58,38 --frames "$frames" "$@"
echo "display server: $(awk "BEGIN { printf \"%.2f\", ($(used) - $before) * 10 / ($frames + 10) }") processor ms a frame; load: $(cut -d' ' -f1-3 /proc/loadavg)"
