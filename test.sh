#!/usr/bin/env bash
# ./test.sh [CTEST OPTIONS]: installs what is missing, builds the release and runs every test.
# ./test.sh -L unit runs the unit tests alone; labels: unit models render ui validator.
# With CI=true warnings are errors, and what a test lacks (models, EGL, a tool) fails instead of
# skipping.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$root"
build=$root/build/release
validator=gltf-validator@2.0.0-dev.3.10

# shellcheck source=assets/packages.sh
source assets/packages.sh
install_packages "${build_packages[@]}" "${test_packages[@]}"
command -v npm >/dev/null || install_packages nodejs npm

mkdir -p "$build"
if [ ! -f "$build/npm/$validator" ]; then
    echo "Installing $validator into build/release/npm"
    rm -rf "$build/npm"
    mkdir -p "$build/npm"
    npm install --prefix "$build/npm" --no-save --no-audit --no-fund --loglevel=error "$validator" </dev/null
    touch "$build/npm/$validator"
fi

werror=OFF
[ "${CI:-}" = true ] && werror=ON
cmake --preset release -DLODESTONE_WITH_TESTS=ON -DLODESTONE_WITH_BENCH=ON \
    -DLODESTONE_WERROR=$werror
cmake --build --preset release

[ -d ../shared/models ] || echo "No ../shared/models: the sweeps over real models are skipped."
# One run of CTest, so that its summary is the last word.
exec ctest --test-dir "$build" --output-on-failure --no-tests=error --parallel "$(nproc)" "$@"
