#!/usr/bin/env bash
# Debian's games that use ODE, played unattended in a virtual display: the same keys on libode and on this library, in lockstep with the
# frames and not with the clock (foreign/lockstep.c), and the bodies of each step compared. What it showed: docs/drop-in.md.
#
#   cargo build --release -p libode && tools/foreign.sh [--install] [FOLDER WITH libode.so]
#
# Needs Debian and, unless they are there, --install as root: the games, xvfb, gcc, python3 and libode-dev. It takes two minutes.
# Pictures are not compared. It fails if a game ends otherwise than on libode, or parts from it sooner than rounding explains.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
if [ "${1:-}" = --install ]; then
    apt-get install -y --no-install-recommends mu-cade xmoto mokomaze stormbaancoureur xvfb libgl1-mesa-dri gcc libc6-dev libode-dev python3
    shift
fi
library=$(readlink -f "${1:-$here/../target/release}/libode.so")
[ -f "$library" ] || { echo "no $library: cargo build --release -p libode" >&2; exit 2; }
libode=$(/sbin/ldconfig -p | awk '$1 == "libode.so.8" { print $NF; exit }')
work=$(mktemp -d)
xvfb=
trap '[ -z "$xvfb" ] || kill "$xvfb"; rm -rf "$work"' EXIT
mkdir "$work/libode" "$work/ferrode"
ln -s "$libode" "$work/libode/libode.so.8"
ln -s "$library" "$work/ferrode/libode.so.8"
gcc -O1 -shared -fPIC -w -fno-builtin-exit -o "$work/lockstep.so" "$here/foreign/lockstep.c" -ldl
Xvfb -displayfd 1 -noreset -screen 0 1024x768x24 > "$work/display" 2> "$work/xvfb.out" &
xvfb=$!
until [ -s "$work/display" ]; do
    kill -0 "$xvfb" || { cat "$work/xvfb.out" >&2; exit 2; }
    sleep 0.2
done
export DISPLAY=:$(cat "$work/display")

failed=0
# play NAME STEPS UNTIL TOLERANCE KEYS COMMAND…: so many steps on either library, which must agree until step UNTIL.
play() {
    local name=$1 steps=$2 until=$3 tolerance=$4 keys=$5 which status
    shift 5
    echo "$name"
    for which in libode ferrode; do
        rm -rf "$work/home"
        mkdir "$work/home"
        status=0
        # Without random addresses, and with a home of its own.
        env HOME="$work/home" SDL_AUDIODRIVER=dummy LIBGL_ALWAYS_SOFTWARE=1 timeout -k 5 120 \
            setarch -R env LD_LIBRARY_PATH="$work/$which" LOCKSTEP_LOG="$work/$name.$which" LOCKSTEP_STEPS="$steps" \
            LOCKSTEP_KEYS="$keys" LD_PRELOAD="$work/lockstep.so" "$@" > "$work/$name.$which.out" 2>&1 || status=$?
        echo "$status" > "$work/$name.$which.status"
        if [ ! -s "$work/$name.$which" ]; then
            echo "  no step on $which; it said:"
            tail -n 20 "$work/$name.$which.out" | sed 's/^/    /'
            failed=1
            return
        fi
        grep -E '^ODE ' "$work/$name.$which.out" | sed "s/^/  $which says: /" | sort | uniq -c || true
    done
    if ! cmp -s "$work/$name.libode.status" "$work/$name.ferrode.status"; then
        echo "  ends with $(cat "$work/$name.libode.status") on libode, $(cat "$work/$name.ferrode.status") here"
        failed=1
    fi
    python3 "$here/foreign/compare.py" "$work/$name.libode" "$work/$name.ferrode" "$until" "$tolerance" || { echo "  PARTED TOO SOON"; failed=1; }
}

export PATH="$PATH:/usr/games"
play mu-cade 600 60 1e-9 "f100:122 f120:-122 f150:122 f200:276 f260:-276 f300:273 f350:-273" mu-cade -window -nosound
play mokomaze 1000 500 1e-9 "s50:275 s250:-275 s250:274 s450:-274 s450:276 s650:-276 s650:274 s900:-274 s900:275" \
    mokomaze -i keyboard -l 2 -x 640 -y 480
play xmoto 1000 200 1e-9 "s50:273 s500:-273 s500:274 s540:-274 s540:273 s800:32 s802:-32" \
    xmoto --nowww --nosound -win -res 640x480 -p test -l tut1
# One block stands on its floor to the last bit, so that rounding decides whether it touches: the first step may differ.
PLODE_NO_SOUND=1 PLODE_NO_SHADOWS=1 PLODE_LOW_DETAIL=1 \
    play stormbaancoureur 1000 0 1e-9 "f20:32 f22:-32 s100:97 s500:44 s650:-44 s700:46 s850:-46" stormbaancoureur
exit $failed
