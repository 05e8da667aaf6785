#!/usr/bin/env bash
# ./run.sh [FILE]: installs what is missing (Debian, Ubuntu), builds the release and opens the
# window. Without a display the program says so and writes the comparison of the sample scene: a
# picture, a page (lodestone-comparison.png, .html) and a table.
# Every argument goes to the program: ./run.sh --help, ./run.sh info FILE, ...
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$root/build/release

# shellcheck source=assets/packages.sh
source "$root/assets/packages.sh"
install_packages "${build_packages[@]}"

if [ ! -f "$build/build.ninja" ]; then
    echo "Configuring (once)" >&2
    # Tests and benches need more packages; test.sh turns them on.
    (cd "$root" && cmake --preset release -DLODESTONE_WITH_TESTS=OFF -DLODESTONE_WITH_BENCH=OFF \
        >/dev/null)
fi
echo "Building (the first time takes some minutes)" >&2
cmake --build "$build" --target lodestone >&2
exec "$build/lodestone" "$@"
