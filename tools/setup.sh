# Shared by the programs in tools: installs what is missing, builds what has changed.
# To be sourced by bash. Everything it says goes to stderr: stdout belongs to the program.

root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
setupLog=  # of this call, once it has one

# Package and what it is for; the same names in Debian 12 and 13.
buildPackages=(
    "g++                       compiles glim"
    "cmake                     configures the build"
    "ninja-build               runs the build"
    "glslang-tools             compiles the kernels to SPIR-V"
    "spirv-tools               checks and specializes the SPIR-V"
    "libvulkan-dev             Vulkan headers and loader"
    "mesa-vulkan-drivers       Vulkan drivers, among them a software one"
    "libglm-dev                vectors and matrices"
    "libtinygltf-dev           reads glTF"
    "nlohmann-json3-dev        reads and writes JSON"
    "libopenexr-dev            reads and writes EXR"
    "libssl-dev                computes SHA-256 of films"
    "libpng-dev                reads and writes PNG"
    "libjpeg62-turbo-dev       reads and writes JPEG"
    "libwebp-dev               reads and writes WebP"
    "libzstd-dev               reads compressed KTX2"
    "libdraco-dev              reads compressed meshes"
    "libmeshoptimizer-dev      reads compressed meshes of another kind"
    "libcli11-dev              reads the command line"
    "libglfw3-dev              opens the preview's window"
    "libimgui-dev              draws the window's panels"
)
benchPackages=(
    "libembree-dev             traces the same rays, for comparison"
)
studyPackages=(
    "python3                   measures, and writes the study's page"
    "python3-matplotlib        draws the study's plots"
)
venvPackages=(
    "python3                   runs the tool"
    "python3-venv              makes its environment for what comes from PyPI"
)
formatPackages=(
    "clang-format              keeps one style"
)
packagePackages=(
    "dpkg-dev                  finds out what a package depends on"
    "file                      tells cpack which files are programs"
)
wheelPackages=(
    "python3-dev               Python's headers, for the module"
)
fuzzPackages=(
    "clang-19                  compiles the fuzz targets"
    "libclang-rt-19-dev        has libFuzzer and the sanitizers"
    "llvm-19                   names the functions in their reports"
)
testPackages=(
    "libgtest-dev              runs the tests"
    "vulkan-validationlayers   checks every use of Vulkan in the tests"
    "xvfb                      is the screen of the preview's tests"
    "x11-xserver-utils         tells it how dense its pixels are"
    "xdotool                   presses its keys and moves its mouse"
    "xauth                     lets a session by hand on it (xvfb-run)"
    "python3-venv              installs what six tests need from PyPI"
    "${wheelPackages[@]}"
    "python3-yaml              reads the workflow that README.md shows"
    "openssl                   makes certificates for the farm's tests"
    "${studyPackages[@]}"
    "${formatPackages[@]}"
)
browserPackages=(
    "chromium                  opens the study's live page in its test"
)

# asksForHelp ARGUMENT...: for help nothing is installed and nothing is built.
asksForHelp() {
    local argument
    for argument in "$@"; do
        [[ $argument == --help || $argument == --help-all || $argument == -h ]] && return
    done
    return 1
}

# asksPythonForHelp ARGUMENT...: the same, of a program that needs python3 to say what it does.
asksPythonForHelp() {
    asksForHelp "$@" || return
    command -v python3 >/dev/null || fail "no python3 was found, which prints this help; $(namePackages python3)"
}

say() { printf 'glim: %s\n' "$*" >&2; }

# fail SENTENCE: shows what the failed step wrote, then the sentence.
fail() {
    [[ -s $setupLog ]] && cat "$setupLog" >&2
    say "$*"
    exit 1
}

# True on Debian 12 or newer (testing and unstable have no version).
isDebian() (
    [[ -r /etc/os-release ]] && source /etc/os-release &&
        [[ ${ID:-} == debian && ${VERSION_ID:-99} -ge 12 ]] && command -v apt-get >/dev/null
)

asRoot() {
    if [[ $(id -u) == 0 ]]; then
        "$@"
    elif [[ -t 0 ]]; then
        sudo "$@"
    else
        sudo -n "$@"
    fi
}

# showProgress WHAT: copies its input to the log, and says how far it is: every second on a terminal, else every ten seconds.
showProgress() {
    local line part='' start=$SECONDS next period=10 redraw='' end='\n' done='' status
    [[ -t 2 ]] && period=1 redraw='\r\033[K' end=''
    next=$((start + period))
    while true; do
        status=0
        IFS= read -r -t 1 line || status=$?
        part+=$line  # after a second without the end of a line, that is what has come of it
        if [[ $status == 0 ]]; then
            printf '%s\n' "$part" >>"$setupLog"
            [[ $part =~ ^\[([0-9]+)/([0-9]+)\] ]] && done="${BASH_REMATCH[1]} of ${BASH_REMATCH[2]} steps"  # ninja's
            part=''
        elif [[ $status -le 128 ]]; then
            break
        fi
        if [[ $SECONDS -ge $next ]]; then
            printf "${redraw}glim: %s, %s$end" "$1" "${done:-$((SECONDS - start)) s}" >&2
            next=$((SECONDS + period))
        fi
    done
    printf '%s' "$part" >>"$setupLog"
    printf "$redraw" >&2
}

# updateLists: fetches apt's lists of packages. Fails if no server answers within 15 s: apt itself waits for minutes.
updateLists() {
    local update=(env LC_ALL=C apt-get update -q) status=0
    asRoot timeout --foreground 15 "${update[@]}" </dev/null 2>&1 | showProgress "fetching apt's lists" || status=$?
    grep -qE '^(Get|Hit):' "$setupLog" || return
    # A slow network gets its time. What is there already is not fetched again.
    [[ $status != 124 ]] || asRoot "${update[@]}" </dev/null 2>&1 | showProgress "fetching apt's lists" || true
}

# downloadPackage PACKAGE FOLDER: by apt, which verifies it. Needs no root. Fails if no server answers within 15 s.
downloadPackage() {
    (cd "$2" && LC_ALL=C apt-get download -q -o Acquire::http::Timeout=15 -o Acquire::Retries=0 "$1" </dev/null 2>&1) |
        showProgress "fetching $1"
}

# extractSwiftShader FOLDER: from the package in it, which is removed.
extractSwiftShader() {
    local inside=./usr/lib/chromium
    dpkg-deb --fsys-tarfile "$1"/*.deb |
        tar -x -C "$1" --strip-components=4 $inside/libvk_swiftshader.so $inside/vk_swiftshader_icd.json 2>>"$setupLog" &&
        rm "$1"/*.deb
}

# ensureSwiftShader DIRECTORY: fetches a software driver of another kind than Mesa's into DIRECTORY/swiftshader, out of Debian's package of
# what all Chromium browsers share: 32 MB, of which 5 are kept. Nothing is installed. Where Debian's packages cannot be reached it says so, and
# leaves no driver.
ensureSwiftShader() {
    local folder=$1/swiftshader new=$1/swiftshader.new package=chromium-common
    [[ -r $folder/vk_swiftshader_icd.json ]] && return
    if ! isDebian; then
        say "WARNING: tests on SwiftShader, the second driver, are skipped: it comes from Debian's package $package, and this is not Debian"
        return
    fi
    (
        until flock -w 10 9; do say "waiting for another build in $1"; done
        [[ -r $folder/vk_swiftshader_icd.json ]] && exit
        setupLog=$1/setup.log
        : >"$setupLog"
        rm -rf "$new" && mkdir "$new"
        say "fetching SwiftShader, the second driver of the tests, from Debian's package $package (32 MB)"
        if downloadPackage $package "$new" || { updateLists && downloadPackage $package "$new"; }; then
            extractSwiftShader "$new" || fail "Debian's package $package has no SwiftShader that can be unpacked"
            mv "$new" "$folder"
        elif downloadPackage libvulkan1 "$new"; then
            fail "apt-get could not download $package, although it downloads other packages"
        else
            say "WARNING: tests on SwiftShader, the second driver, are skipped: no server of Debian's packages answers"
            rm -rf "$new"
        fi
    ) 9>"$1/.lock"
}

# installMissing PACKAGE_LINE...
installMissing() {
    local installed line missing=() names=() offline=()
    installed=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "${@%% *}" 2>/dev/null | sed -n 's/ installed$//p' || true)
    for line in "$@"; do
        if ! grep -qxF -- "${line%% *}" <<<"$installed"; then
            missing+=("$line")
            names+=("${line%% *}")
        fi
    done
    [[ ${#names[@]} == 0 ]] && return
    say "installing with apt-get what is missing:"
    printf '    %s\n' "${missing[@]}" >&2
    # Before there is progress to show, since sudo may ask for a password.
    asRoot apt-get --version >/dev/null || fail "neither root nor sudo is at hand; as root, run: apt-get install ${names[*]}"
    # Without a network the packages may still be there.
    updateLists || offline=(--no-download)
    asRoot env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${offline[@]}" \
        -o DPkg::Lock::Timeout=300 "${names[@]}" </dev/null 2>&1 | showProgress "installing" ||
        fail "apt-get could not install${offline:+, because no server of packages answers (is there a network?)}: ${names[*]}"
}

# The sentence for systems whose packages we do not know.
namePackages() { echo "please install what Debian calls ${*%% *}, then run this again"; }

requireTools() {
    local tool
    for tool in g++ cmake ninja glslangValidator spirv-val; do
        command -v $tool >/dev/null || fail "$tool was not found and this is not Debian 12 or newer: $(namePackages "$@")"
    done
}

# Prints what cmake is to know of the module for Python, a line each. The module comes with the tests where PyPI can be reached.
describeModule() {
    local preset=$1 tests=$2
    if [[ $tests != OFF && $preset != debug && $preset != sanitize* ]] &&
        python3 "$root/tools/python_environment.py" 2>&1 | showProgress "preparing the module for Python"; then
        printf '%s\n' -DGLIM_PYTHON_MODULE=ON "-DPython_EXECUTABLE=$root/build/python/bin/python"
    else
        echo "-DGLIM_PYTHON_MODULE=OFF"
    fi
}

# configure DIRECTORY PRESET TESTS: runs cmake unless it has run here with the same arguments. TESTS: OFF, ON, or BENCH, which includes ON.
configure() {
    local directory=$1 preset=$2 tests=$3 key fresh=() before= module
    [[ -f $directory/.configured ]] && before=$(<"$directory/.configured")
    # A call that needs fewer packages leaves on what another call has turned on.
    [[ $before == *" ON "* && $tests == OFF ]] && tests=ON
    [[ $before == *" BENCH "* ]] && tests=BENCH
    mapfile -t module < <(describeModule "$preset" "$tests")
    key="$preset $tests ${module[0]} $root"
    [[ -f $directory/build.ninja && -f $directory/.configured && $(<"$directory/.configured") == "$key" ]] && return
    # CMake refuses a build directory that was moved along with its sources.
    [[ -f $directory/.configured && $(<"$directory/.configured") != *" $root" ]] && fresh=(--fresh)
    (cd "$root" && cmake "${fresh[@]}" --preset "$preset" "-DGLIM_TESTS=${tests/BENCH/ON}" "-DGLIM_BENCH=${tests/#ON/OFF}" "${module[@]}") \
        2>&1 | showProgress "configuring" || return
    printf '%s' "$key" >"$directory/.configured"
}

# What the binary says of itself besides its sources: a new commit is a new build even if no file is newer.
describeBuild() { echo "$1 $root $(git -c safe.directory="$root" -C "$root" rev-parse HEAD 2>/dev/null || echo unknown)"; }

# isOutdated FILE: a source is newer.
isOutdated() { [[ -n $(cd "$root" && find CMakeLists.txt CMakePresets.json host python shaders tests tools -newer "$1" -print -quit) ]]; }

# isBuilt STAMP PRESET: no source is newer than the stamp, and it is of the same preset and commit. A few milliseconds.
isBuilt() {
    [[ -x ${1%/*}/glim && -f $1 && $(<"$1") == "$(describeBuild "$2")" ]] || return
    ! isOutdated "$1"
}

# build DIRECTORY PRESET TESTS TARGETS PACKAGE_LINE...: called under the lock. TARGETS: one word or several in one argument.
build() {
    local directory=$1 preset=$2 tests=$3 target=$4 stamp=$1/.built-$4 start=$SECONDS hint=
    shift 4
    isBuilt "$stamp" "$preset" && return
    setupLog=$directory/setup.log
    : >"$setupLog"
    if isDebian; then
        installMissing "$@"
    else
        requireTools "$@"
        hint="; this is not Debian 12 or newer, so if something is missing: $(namePackages "$@")"
    fi
    # Before the build, so that what is edited meanwhile counts as newer.
    describeBuild "$preset" >"$stamp.new"
    say "building in $directory"
    configure "$directory" "$preset" "$tests" || fail "cmake could not configure the build$hint"
    cmake --build "$directory" --target $target 2>&1 | showProgress "building" || fail "the build failed$hint"
    mv "$stamp.new" "$stamp"
    say "built in $((SECONDS - start)) s"
}

# ensureBuilt DIRECTORY PRESET TESTS TARGETS PACKAGE_LINE...: returns fast if nothing has changed. If several run at a time, one builds and
# the others wait.
ensureBuilt() {
    isBuilt "$1/.built-$4" "$2" && return
    mkdir -p "$1" 2>/dev/null && [[ -w $1 ]] || fail "cannot write to $1, where glim is to be built"
    (
        until flock -w 10 9; do say "waiting for another build in $1"; done
        build "$@"
    ) 9>"$1/.lock"
}

# ensure COMMAND SENTENCE PACKAGE_LINE...: installs the packages unless the command succeeds. The sentence says what is missing without them.
ensure() {
    local command=$1 missing=$2
    shift 2
    $command >/dev/null 2>&1 && return
    isDebian || fail "$missing and this is not Debian 12 or newer: $(namePackages "$@")"
    mkdir -p "$root/build" 2>/dev/null && [[ -w $root/build ]] || fail "cannot write to $root/build, where the log goes"
    setupLog=$root/build/setup.log
    : >"$setupLog"
    installMissing "$@"
    $command >/dev/null || fail "$missing, although it is installed"
}

# ensureTool TOOL PACKAGE_LINE...
ensureTool() { ensure "command -v $1" "$1 was not found" "${@:2}"; }

# Python and what makes its environments.
ensureVenv() { ensure "python3 -m ensurepip --version" "no python3 with venv was found" "${venvPackages[@]}"; }

hasPythonHeaders() {
    python3 -c 'import os, sysconfig; raise SystemExit(not os.path.exists(sysconfig.get_path("include") + "/Python.h"))'
}

# The first Python that has what the study needs; a user's own may shadow the system's.
findPython() {
    local python
    for python in python3 /usr/bin/python3; do
        "$python" -c 'import matplotlib' 2>/dev/null && echo "$python" && return
    done
    return 1
}

# Prints which Python to run, after installing what is missing.
ensurePython() {
    ensure findPython "no python3 with matplotlib was found" "${studyPackages[@]}"
    findPython
}
