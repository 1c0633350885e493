# pkg_config.sh PKG_CONFIG PREFIX SOURCE PROGRAM COMPILER...: compiles by what the installed batten.pc says, and runs.
set -eu
pkg_config=$1 prefix=$2 source=$3 program=$4
shift 4
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name batten.pc)")
export PKG_CONFIG_PATH
"$pkg_config" --exists --print-errors batten
# shellcheck disable=SC2046
"$@" "$source" $("$pkg_config" --cflags --libs batten) -o "$program"
LD_LIBRARY_PATH=$(dirname "$PKG_CONFIG_PATH") "$program"
