# pkg_config.sh PKG_CONFIG PREFIX MODULE SOURCE PROGRAM COMPILER...: compiles by what the installed MODULE.pc says, and runs.
set -eu
pkg_config=$1 prefix=$2 module=$3 source=$4 program=$5
shift 5
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name batten.pc)")
export PKG_CONFIG_PATH
"$pkg_config" --exists --print-errors "$module"
# shellcheck disable=SC2046
"$@" "$source" $("$pkg_config" --cflags --libs "$module") -o "$program"
LD_LIBRARY_PATH=$(dirname "$PKG_CONFIG_PATH") "$program"
