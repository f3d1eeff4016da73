#!/bin/sh
# Installs the C interface (libode.so.8, libode.a, headers, pkg-config, ode-config, CMake) below a prefix, or takes it out
# again. Builds it first, unless told where it was built.
set -eu

usage() {
    cat <<'TEXT'
usage: install.sh --prefix DIR [--single] [--no-trimesh] [--no-debug] [--drawstuff] [--from DIR] [--uninstall]

  --prefix DIR    where to: DIR/lib, DIR/include/ode, DIR/bin (DESTDIR is put before it while copying)
  --single        dReal is float: the library goes to DIR/lib/ode-single, its files are ode-single.pc,
                  ode-single-config and the CMake package ode-single
  --no-trimesh    without triangle meshes
  --no-debug      release mode: arguments are not reported to the debug handler
  --drawstuff     also libdrawstuff, on which ODE's demo programs show themselves (docs/drawstuff.md)
  --from DIR      take libode.so and libode.a (and libdrawstuff.so) from there instead of building them
  --uninstall     remove what was installed
TEXT
}

fail() {
    echo "install.sh: $1" >&2
    exit 1
}

prefix= from= features= uninstall= drawstuff= precision=dDOUBLE suffix=
while [ $# -gt 0 ]; do
    case $1 in
        --prefix) [ $# -gt 1 ] || fail "--prefix needs a folder"; prefix=$2; shift ;;
        --prefix=*) prefix=${1#*=} ;;
        --from) [ $# -gt 1 ] || fail "--from needs a folder"; from=$2; shift ;;
        --from=*) from=${1#*=} ;;
        --single) precision=dSINGLE suffix=-single features="$features single" ;;
        --no-trimesh) features="$features no-trimesh" ;;
        --no-debug) features="$features no-debug" ;;
        --drawstuff) drawstuff=yes ;;
        --uninstall) uninstall=yes ;;
        -h | --help) usage; exit 0 ;;
        *) usage >&2; fail "unknown option $1" ;;
    esac
    shift
done
[ -n "$prefix" ] || { usage >&2; fail "--prefix is missing"; }
case $prefix in /*) ;; *) prefix=$PWD/$prefix ;; esac

source=$(cd "$(dirname "$0")" && pwd)
root=${DESTDIR:-}$prefix
version=0.16.2
real=libode.so.8.0.2
lib=lib
other=$root/lib/ode-single/$real
if [ -n "$suffix" ]; then
    lib=lib/ode-single
    other=$root/lib/$real
fi
cmake=lib/cmake/ode$suffix

if [ -n "$uninstall" ]; then
    for name in $real libode.so.8 libode.so libode.a; do rm -f "$root/$lib/$name"; done
    rm -f "$root/lib/pkgconfig/ode$suffix.pc" "$root/bin/ode$suffix-config"
    rm -f "$root/$cmake/ode$suffix-config.cmake" "$root/$cmake/ode$suffix-config-version.cmake"
    # Both precisions share the headers, and libdrawstuff.
    if ! [ -e "$other" ]; then
        for name in libdrawstuff.so.0 libdrawstuff.so pkgconfig/drawstuff.pc; do rm -f "$root/lib/$name"; done
        for header in drawstuff.h version.h; do rm -f "$root/include/drawstuff/$header"; done
        for header in "$source"/crates/libode/include/ode/*.h; do rm -f "$root/include/ode/${header##*/}"; done
    fi
    for folder in "$lib" "$cmake" lib/cmake lib/pkgconfig lib include/ode include/drawstuff include bin; do
        rmdir "$root/$folder" 2>/dev/null || true
    done
    echo "removed from $root"
    exit 0
fi

if [ -z "$from" ]; then
    from=${CARGO_TARGET_DIR:-$source/target}
    # A build with features has a folder of its own, so that none is taken for another.
    name=$(echo "$features" | tr -d ' ')
    from=$from${name:+/ode-$name}
    (cd "$source" && cargo build --release --locked -p libode --features "$features" --target-dir "$from")
    if [ -n "$drawstuff" ]; then
        (cd "$source" && cargo build --release --locked -p drawstuff --target-dir "$from")
    fi
    from=$from/release
fi
[ -e "$from/libode.so" ] && [ -e "$from/libode.a" ] || fail "no libode.so and libode.a in $from"

mkdir -p "$root/$lib" "$root/lib/pkgconfig" "$root/$cmake" "$root/include/ode" "$root/bin"
# A library that a program uses now must not change under it: copy beside it, then rename.
cp "$from/libode.so" "$root/$lib/$real.new"
if command -v strip >/dev/null; then strip --strip-debug "$root/$lib/$real.new"; fi
chmod 755 "$root/$lib/$real.new"
mv "$root/$lib/$real.new" "$root/$lib/$real"
ln -sf $real "$root/$lib/libode.so.8"
ln -sf libode.so.8 "$root/$lib/libode.so"
cp "$from/libode.a" "$root/$lib/libode.a"
cp "$source"/crates/libode/include/ode/*.h "$root/include/ode/"
chmod 644 "$root/$lib/libode.a" "$root"/include/ode/*.h

# What the static library needs of the system (rustc --print native-static-libs).
private="-lgcc_s -lutil -lrt -lpthread -lm -ldl -lc"

cat > "$root/lib/pkgconfig/ode$suffix.pc" <<TEXT
prefix=$prefix
exec_prefix=\${prefix}
libdir=\${prefix}/$lib
includedir=\${prefix}/include
precision=$precision

Name: ode$suffix
Description: Open Dynamics Engine (Ferrode's)
Version: $version
Libs: -L\${libdir} -lode
Libs.private: $private
Cflags: -I\${includedir} -D\${precision}
TEXT

cat > "$root/bin/ode$suffix-config" <<TEXT
#!/bin/sh
# Flags of programs that use the library.
prefix=$prefix
exec_prefix=
usage="usage: ode$suffix-config [--prefix[=DIR]] [--exec-prefix[=DIR]] [--version] [--cflags] [--libs]"
[ \$# -gt 0 ] || { echo "\$usage" >&2; exit 1; }
for option; do
    case \$option in
        --prefix=*) prefix=\${option#*=} ;;
        --prefix) echo "\$prefix" ;;
        --exec-prefix=*) exec_prefix=\${option#*=} ;;
        --exec-prefix) echo "\${exec_prefix:-\$prefix}" ;;
        --version) echo "$version" ;;
        --cflags) echo "-I\$prefix/include -D$precision" ;;
        --libs) echo "-L\${exec_prefix:-\$prefix}/$lib -lode" ;;
        *) echo "\$usage" >&2; exit 1 ;;
    esac
done
TEXT
chmod 755 "$root/bin/ode$suffix-config"

# The CMake package finds itself, so a prefix can be moved.
target=ODE$(echo "$suffix" | tr -d - | tr '[:lower:]' '[:upper:]' | sed 's/^SINGLE$/_SINGLE/')
cat > "$root/$cmake/ode$suffix-config.cmake" <<TEXT
# The target ODE::$target, and the same as a static library: ODE::${target}_STATIC.
get_filename_component(_ode_prefix "\${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
if(NOT TARGET ODE::$target)
  add_library(ODE::$target SHARED IMPORTED)
  set_target_properties(ODE::$target PROPERTIES
    IMPORTED_LOCATION "\${_ode_prefix}/$lib/libode.so"
    IMPORTED_SONAME "libode.so.8"
    INTERFACE_COMPILE_DEFINITIONS "$precision"
    INTERFACE_INCLUDE_DIRECTORIES "\${_ode_prefix}/include")
  add_library(ODE::${target}_STATIC STATIC IMPORTED)
  set_target_properties(ODE::${target}_STATIC PROPERTIES
    IMPORTED_LOCATION "\${_ode_prefix}/$lib/libode.a"
    INTERFACE_LINK_LIBRARIES "$(echo "$private" | sed 's/-l//g; s/ /;/g')"
    INTERFACE_COMPILE_DEFINITIONS "$precision"
    INTERFACE_INCLUDE_DIRECTORIES "\${_ode_prefix}/include")
endif()
unset(_ode_prefix)
TEXT
cat > "$root/$cmake/ode$suffix-config-version.cmake" <<TEXT
set(PACKAGE_VERSION "$version")
if(PACKAGE_FIND_VERSION VERSION_GREATER PACKAGE_VERSION)
  set(PACKAGE_VERSION_COMPATIBLE FALSE)
else()
  set(PACKAGE_VERSION_COMPATIBLE TRUE)
  if(PACKAGE_FIND_VERSION VERSION_EQUAL PACKAGE_VERSION)
    set(PACKAGE_VERSION_EXACT TRUE)
  endif()
endif()
TEXT

if [ -n "$drawstuff" ]; then
    [ -e "$from/libdrawstuff.so" ] || fail "no libdrawstuff.so in $from"
    mkdir -p "$root/lib" "$root/include/drawstuff"
    cp "$from/libdrawstuff.so" "$root/lib/libdrawstuff.so.0.new"
    if command -v strip >/dev/null; then strip --strip-debug "$root/lib/libdrawstuff.so.0.new"; fi
    chmod 755 "$root/lib/libdrawstuff.so.0.new"
    mv "$root/lib/libdrawstuff.so.0.new" "$root/lib/libdrawstuff.so.0"
    ln -sf libdrawstuff.so.0 "$root/lib/libdrawstuff.so"
    cp "$source"/crates/drawstuff/include/drawstuff/*.h "$root/include/drawstuff/"
    chmod 644 "$root"/include/drawstuff/*.h
    cat > "$root/lib/pkgconfig/drawstuff.pc" <<TEXT
prefix=$prefix
libdir=\${prefix}/lib
includedir=\${prefix}/include

Name: drawstuff
Description: DrawStuff, on which ODE's demo programs show themselves (Ferrode's)
Version: $version
Libs: -L\${libdir} -ldrawstuff
Cflags: -I\${includedir}
TEXT
fi
echo "installed in $root"
