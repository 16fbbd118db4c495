# For tools/test --watch, which sources it: runs the test of a kernel after each change of a file that it is made of.

# findWatched NAME: prints the file of tests/kernels, without .cpp, that NAME means: that of a suite, of a test, or of the file itself.
findWatched() {
    local stem=${1##*/}
    stem=${stem%.cpp}
    stem=${stem%.comp}
    if [[ -f $root/tests/kernels/$stem.cpp ]]; then
        echo "$stem"
    elif [[ -f $root/tests/kernels/$stem.comp ]]; then
        (cd "$root/tests/kernels" && grep -lwF "test_kernels::$stem" -- *.cpp | sed 's,\.cpp$,,')
    else
        suitePrograms "${1%%.*}" | sed -n 's,^kernels_,,p'
    fi | head -n 1
}

# filterFor NAME: prints gtest's filter. Suites and tests with parameters have the names of instances before and behind.
filterFor() {
    case $1 in
        [A-Z]*.*) echo "$1:*/$1/*" ;;
        [A-Z]*) echo "$1.*:*/$1.*" ;;
        *) echo '*' ;;
    esac
}

# What a test of a kernel may be made of, a line each: time, inode (editors replace files), name.
listSources() {
    (cd "$root" && find shaders tests/kernels tests/support tests/harness -type f -printf '%T@ %i %p\n' 2>/dev/null | LC_ALL=C sort)
}

# watch FILE FILTER: until a signal ends it. FILE is one that findWatched prints.
watch() {
    local source=tests/kernels/$1.cpp target=kernels_$1 filter=$2
    local fresh sources test= kernels=()
    local -A pending=()  # kernels that are to be compiled
    local isStale=1      # the test's program
    local isAgain=       # a file has changed while the test ran
    findKernels
    [[ ${#kernels[@]} -gt 0 ]] || refuse "--watch: $source has no kernel of its own, expected a test that runs one of tests/kernels/*.comp"
    (ensureBuilt "$directory" "$preset" ON mark_floats "${buildPackages[@]}" "${testPackages[@]}") || exit
    fresh=$(mktemp -d "$directory/watch.XXXXXX")
    trap 'stopTest; rm -rf "$fresh"' EXIT
    trap 'exit 130' INT
    trap 'exit 143' TERM
    sources=$(listSources)
    while true; do
        runOnce || true
        until [[ -n $isAgain ]] || isChanged; do sleep 0.1; done
        isAgain=
    done
}

# The kernels that the test names. All are to be compiled.
findKernels() {
    local kernel
    mapfile -t kernels < <(grep -oE 'test_kernels::[a-z0-9_]+' "$root/$source" | sed 's,.*::,,' | sort -u)
    for kernel in "${kernels[@]}"; do pending[$kernel]=1; done
}

# Whether a file of the test has changed since the last call; notes what that makes stale.
isChanged() {
    local now settled file files relevant=
    now=$(listSources)
    [[ $now != "$sources" ]] || return
    # An editor may write in several steps.
    until settled=$now && sleep 0.03 && now=$(listSources) && [[ $now == "$settled" ]]; do :; done
    mapfile -t files < <(LC_ALL=C comm -13 <(echo "$sources") <(echo "$now") | cut -d ' ' -f 3-)
    sources=$now
    for file in "${files[@]}"; do
        noteChange "$file" && relevant=1
    done
    [[ -n $relevant ]]
}

# noteChange FILE: fails if the test does not depend on it.
noteChange() {
    local kernel isIncluded=
    case $1 in
        "$source" | tests/support/*.[ch]pp | tests/harness/*.[ch]pp)
            isStale=1
            findKernels
            return
            ;;
        *.comp | *.glsl | *.h) ;;
        *) return 1 ;;
    esac
    for kernel in "${kernels[@]}"; do
        # A kernel that has never been compiled may include anything.
        if [[ ! -f $fresh/$kernel.spv.d || "$(<"$fresh/$kernel.spv.d") " == *"/$1 "* ]]; then
            pending[$kernel]=1
            isIncluded=1
        fi
    done
    [[ -n $isIncluded ]] || return
    [[ $1 != *.h ]] || isStale=1  # C++ reads it, too
}

# compile KERNEL: into the folder of fresh ones, by the command of the build. Errors have the form that editors know: FILE:LINE: error: ...
compile() {
    local output=$directory/tests/glim_test_kernels command said status=0
    command=$(ninja -C "$directory" -t commands "tests/glim_test_kernels/$1.spv" 2>/dev/null | tail -n 1)
    [[ $command == *"$output/$1.spv"* ]] || return 0  # the build has yet to find it
    command=${command% && * cmake_transform_depfile *}
    said=$(eval "${command//"$output/"/"$fresh/"}" 2>&1) || status=1
    said=${said//"$fresh/$1.spv.plain:"/"tests/kernels/$1.comp: error:"}
    sed -E -e '/^$|^ERROR: [0-9]+ compilation errors|^ERROR: Linking .*entry point|^SPIR-V is not generated/d' \
        -e "s/^(ERROR|WARNING): ([^:]+:[0-9]+): *('' *: *)?/\2: \L\1\E: /" <<<"${said//"$root/"/}" | sed '/^$/d'
    return $status
}

# Compiles and builds what is stale, then runs the test. Fails where it could not, and is tried again after the next change.
runOnce() {
    local start=${EPOCHREALTIME/[.,]/} kernel verdict=passes status=0 said hundredths
    for kernel in "${!pending[@]}"; do
        if compile "$kernel"; then
            unset "pending[$kernel]"
        else
            echo "glim: $kernel.comp does not compile"
        fi
    done
    [[ ${#pending[@]} == 0 ]] || return
    if [[ -n $isStale ]]; then
        (ensureBuilt "$directory" "$preset" ON "$target" "${buildPackages[@]}" "${testPackages[@]}") || return
        isStale=
    fi
    (cd "$directory/tests" && GLIM_VALIDATION=1 GLIM_TEST_KERNELS=$fresh exec "./$target" --gtest_brief=1 "--gtest_filter=$filter") \
        >"$fresh/said" 2>&1 &
    test=$!
    while kill -0 "$test" 2>/dev/null; do
        sleep 0.05
        if isChanged; then
            stopTest
            isAgain=1
            return
        fi
    done
    wait "$test" || status=$?
    test=
    said=$(<"$fresh/said")
    said=${said#Running main() from *$'\n'}
    echo "${said//"$root/"/}"
    [[ $status == 0 ]] || verdict=fails
    hundredths=$(((${EPOCHREALTIME/[.,]/} - start) / 10000))
    printf 'glim: %s %s (%d.%02d s)\n' "${source##*/}" "$verdict" $((hundredths / 100)) $((hundredths % 100))
}

stopTest() {
    [[ -z $test ]] || kill "$test" 2>/dev/null || true
    [[ -z $test ]] || wait "$test" 2>/dev/null || true
    test=
}
