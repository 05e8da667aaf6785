#!/usr/bin/env bash
# bench/run.sh [OPTIONS]: installs the peers, builds the release and measures; writes
# bench/RESULTS.md and bench/peers.csv, anew after every part. Parts are kept in
# build/release/bench-parts: broken off and started again at the same commit, it goes on where it
# stopped. Options go to lodestone_bench (--quick, --peers, --only Maple, --again, ...); with options
# of your own, --out and --csv are yours to give as well.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
build=$root/build/release
modules=(meshoptimizer@1.3.0 gltfpack@1.3.0 @gltf-transform/cli@4.5.1)

# shellcheck source=../assets/packages.sh
source assets/packages.sh
install_packages "${build_packages[@]}" "${bench_packages[@]}"

installed="$build/npm-peers/${modules[*]//[\/ ]/-}"
if [ ! -f "$installed" ]; then
    echo "Installing ${modules[*]} into build/release/npm-peers"
    rm -rf "$build/npm-peers"
    mkdir -p "$build/npm-peers"
    npm install --prefix "$build/npm-peers" --no-save --no-audit --no-fund --loglevel=error \
        "${modules[@]}" </dev/null
    touch "$installed"
fi

cmake --preset release -DLODESTONE_WITH_BENCH=ON
cmake --build --preset release --target lodestone_bench
if [ $# = 0 ]; then
    set -- --out bench/RESULTS.md --csv bench/peers.csv
fi
exec "$build/lodestone_bench" --parts "$build/bench-parts" "$@"
