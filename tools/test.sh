#!/usr/bin/env bash
# Passes all tests. Sets up what they need on a fresh Debian machine; elsewhere the live comparison says that it skips.
set -euo pipefail
cd "$(dirname "$0")/.."

# The live comparison runs the same scenes on an installed libode; it needs its headers and C compilers. The test of the
# installer builds a CMake project.
if command -v apt-get >/dev/null && ! { [ -e /usr/include/ode/ode.h ] && type -P cmake g++ pkg-config >/dev/null; }; then
  if [ "$(id -u)" = 0 ]; then as_root=(); else as_root=(sudo -n); fi
  "${as_root[@]}" apt-get update -qq && "${as_root[@]}" apt-get install -y -qq libode-dev gcc g++ cmake make pkg-config >/dev/null ||
    echo "note: libode-dev and compilers could not be installed; what needs them will be skipped"
fi

# Debian's Python binding of ODE runs unchanged on the C interface.
if command -v apt-get >/dev/null && ! /usr/bin/python3 -c "import ode" 2>/dev/null; then
  if [ "$(id -u)" = 0 ]; then as_root=(); else as_root=(sudo -n); fi
  "${as_root[@]}" apt-get update -qq && "${as_root[@]}" apt-get install -y -qq python3-pyode >/dev/null ||
    echo "note: python3-pyode could not be installed; its test will be skipped"
fi

# So do OMPL and DART with their ODE parts: some 90 MB, half a minute.
if command -v apt-get >/dev/null &&
  ! { [ -e /usr/include/ompl-1.5 ] && [ -e /usr/include/dart/collision/ode/ode.hpp ] && [ -e /usr/include/dart/external/ikfast ]; }; then
  if [ "$(id -u)" = 0 ]; then as_root=(); else as_root=(sudo -n); fi
  "${as_root[@]}" apt-get update -qq && "${as_root[@]}" apt-get install -y -qq --no-install-recommends \
    libompl-dev libdart-dev libdart-collision-ode-dev libdart-external-ikfast-dev >/dev/null ||
    echo "note: OMPL and DART could not be installed; their test will be skipped"
fi

# Pictures are drawn in software where there is no graphics card; windows are opened in a virtual display.
if command -v apt-get >/dev/null && ! { ls /usr/share/vulkan/icd.d/lvp_icd.* >/dev/null 2>&1 && command -v Xvfb >/dev/null; }; then
  if [ "$(id -u)" = 0 ]; then as_root=(); else as_root=(sudo -n); fi
  "${as_root[@]}" apt-get update -qq && "${as_root[@]}" apt-get install -y -qq mesa-vulkan-drivers xvfb >/dev/null ||
    echo "note: mesa-vulkan-drivers and xvfb could not be installed; tests of pictures will be skipped"
fi

# Extra worlds and recorded figures lie beside the checkout where the project is developed.
for pair in FERRODE_WORLDS:../shared/worlds FERRODE_SPEC:../shared/spec; do
  name=${pair%%:*} folder=${pair#*:}
  if [ -z "${!name:-}" ] && [ -d "$folder" ]; then export "$name=$(cd "$folder" && pwd)"; fi
done

# Property tests draw the same cases every time here; leave the variable out to explore.
export PROPTEST_RNG_SEED=${PROPTEST_RNG_SEED:-1}

log=$(mktemp)
trap 'rm -f "$log"' EXIT
status=0
cargo test --workspace --locked --no-fail-fast "$@" 2>&1 | tee "$log" || status=$?
# Cargo closes with the results of the last of many programs; this is the sum of all.
awk '/^test result:/ { passed += $4; failed += $6; ignored += $8 }
     END { printf "\n%d passed, %d failed, %d skipped\n", passed, failed, ignored }' "$log"
exit "$status"
