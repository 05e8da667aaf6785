# The Debian/Ubuntu packages Lodestone needs, and how they get installed.
# Sourced by run.sh, test.sh and .ci/run; the only place that names packages.
# shellcheck shell=bash disable=SC2034

# To build and run the program.
build_packages=(
    g++ cmake ninja-build pkg-config
    libglfw3-dev libimgui-dev libepoxy-dev libegl-dev libopengl-dev libgl-dev libstb-dev
    libfontconfig-dev libfreetype-dev libglm-dev libtinygltf-dev nlohmann-json3-dev libcli11-dev libspdlog-dev
    libtbb-dev libexpected-dev libassimp-dev libembree-dev
    libmeshoptimizer-dev libdraco-dev libwebp-dev
    libegl1 libgl1 libgl1-mesa-dri fontconfig fonts-inter fonts-dejavu-core
)

# To build and run every test and bench besides.
test_packages=(
    git ca-certificates libgtest-dev libbenchmark-dev libcgal-dev
    python3 python3-gi gir1.2-gtk-3.0 xvfb xauth xdotool x11-utils imagemagick
)

# Peers that the bench measures beside us; each is left out, and named as such, where it is missing.
bench_packages=(
    libbenchmark-dev gltfpack libopenmesh-dev libcgal-dev libeigen3-dev libvtk9-dev nodejs npm
)

# To check the sources: format, lint, and clang for the fuzz target.
check_packages=(clang libclang-rt-14-dev clang-format clang-tidy)

# missing_packages NAMES...: prints those not installed, one a line.
missing_packages() {
    local installed
    # Packages dpkg has never heard of make it fail; they are missing, which is the answer.
    installed=$(dpkg-query -W -f='${Package} ${db:Status-Status}\n' "$@" 2>/dev/null || true)
    local name
    for name in "$@"; do
        grep -q -x -F "$name installed" <<<"$installed" || echo "$name"
    done
}

# as_root COMMAND...: runs it as root, through sudo where we are not.
as_root() {
    if [ "$(id -u)" = 0 ]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        echo "error: not root and no sudo; as root run: $*" >&2
        return 1
    fi
}

# install_packages NAMES...: installs what is missing and says so. Silent when nothing is.
install_packages() {
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        echo "No apt here: taking it that these are installed under their local names: $*" >&2
        return 0
    fi
    local missing
    mapfile -t missing < <(missing_packages "$@")
    [ "${#missing[@]}" = 0 ] && return 0
    echo "Installing ${#missing[@]} packages: ${missing[*]}" >&2
    local apt=(env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o Dpkg::Use-Pty=0)
    # A mirror may be in the middle of an update: look once more before giving up.
    as_root "${apt[@]}" update >/dev/null || as_root "${apt[@]}" update
    as_root "${apt[@]}" install --no-install-recommends "${missing[@]}" </dev/null >/dev/null ||
        { as_root "${apt[@]}" update &&
            as_root "${apt[@]}" install --no-install-recommends "${missing[@]}" </dev/null; }
}
