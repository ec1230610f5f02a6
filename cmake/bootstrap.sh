# Shared by ./trapeze and tests/run: packages, configuration, build. Sourced with `root` set to the repository's folder.
# Everything it says goes to standard error; what the tools say goes to build/build.log.

say() { printf 'trapeze: %s\n' "$*" >&2; }

# packages_missing LIST...: names in the lists that dpkg does not have installed.
packages_missing() {
    local wanted have
    wanted=$(cat "$@" | grep -v '^#' | sort -u)
    # shellcheck disable=SC2086
    have=$(dpkg-query -W -f='${Package} ${db:Status-Status}\n' $wanted 2>/dev/null | awk '$2 == "installed" { print $1 }')
    comm -23 <(printf '%s\n' "$wanted") <(printf '%s\n' "$have" | sort -u)
}

# ensure_packages LIST...: installs what is missing, or says what to do and exits with 69 (EX_UNAVAILABLE).
ensure_packages() {
    local stamp="$root/build/.packages" missing as_root=
    stamp+=$(printf -- '-%s' "${@##*/}")
    local list newer=
    for list in "$@"; do [ "$stamp" -nt "$list" ] || newer=1; done
    [ -z "$newer" ] && return 0
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        if command -v cmake >/dev/null && command -v ninja >/dev/null && [ -n "${TRAPEZE_SKIP_PACKAGES:-}" ]; then
            return 0
        fi
        say "this system has no apt-get. Trapeze needs what these Debian 12 packages hold:"
        cat "$@" | grep -v '^#' | sed 's/^/    /' >&2
        say "install their equals and set TRAPEZE_SKIP_PACKAGES=1, or on Debian 12: apt-get install --no-install-recommends $(cat "$@" | grep -v '^#' | tr '\n' ' ')"
        exit 69
    fi
    missing=$(packages_missing "$@" | tr '\n' ' ')
    if [ -n "${missing// /}" ]; then
        if [ "$(id -u)" != 0 ]; then
            if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || { [ -t 0 ] && sudo -v; }; }; then
                as_root=sudo
            else
                say "missing Debian packages: $missing"
                say "install them with: sudo apt-get update && sudo apt-get install --no-install-recommends $missing"
                exit 69
            fi
        fi
        say "installing Debian packages: $missing"
        # shellcheck disable=SC2086
        if ! { $as_root apt-get update && DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y --no-install-recommends $missing; } \
            >"$root/build/packages.log" 2>&1 </dev/null; then
            tail -n 20 "$root/build/packages.log" >&2
            say "could not install the packages (above, and build/packages.log). By hand: apt-get update && apt-get install --no-install-recommends $missing"
            exit 69
        fi
    fi
    touch "$stamp"
}

# configure PRESET [cmake arguments...]
configure() {
    local preset=$1
    shift
    if ! (cd "$root" && cmake --preset "$preset" "$@") >"$root/build/configure.log" 2>&1; then
        grep -A 12 -E 'CMake Error|error:' "$root/build/configure.log" >&2 || tail -n 30 "$root/build/configure.log" >&2
        say "configuration failed; the whole log is build/configure.log"
        exit 70
    fi
}

# progress_of_ninja: turns its lines into one that says how far it is and how long it will take.
progress_of_ninja() {
    local line counts done_ all left start=$SECONDS
    while IFS= read -r line; do
        case $line in \[*/*\]*) ;; *) continue ;; esac
        counts=${line%%]*} counts=${counts#[}
        done_=${counts%/*} all=${counts#*/} left=
        [ $((SECONDS - start)) -ge 5 ] && left=$(((SECONDS - start) * (all - done_) / done_)) &&
            left=", $((left / 60)):$(printf %02d $((left % 60))) left"
        printf '\rtrapeze: building, %d%%%s \033[K' $((100 * done_ / all)) "$left" >&2
    done
}

# build FOLDER TARGET...: one short progress line on a terminal; the first failing command's output when it fails.
# As many compilers at once as there are processors: with the two more that ninja starts by itself they are in each
# other's way.
build() {
    local folder=$1 log="$root/build/build.log" status
    shift
    if [ -t 2 ]; then
        ninja -j "$(nproc)" -C "$folder" "$@" 2>&1 | tee "$log" | progress_of_ninja
        status=${PIPESTATUS[0]}
        printf '\r\033[K' >&2
    else
        ninja -j "$(nproc)" -C "$folder" "$@" >"$log" 2>&1
        status=$?
    fi
    if [ "$status" -ne 0 ]; then
        sed -n '/^FAILED:/,$p' "$log" | head -n 60 >&2
        grep -q '^FAILED:' "$log" || tail -n 20 "$log" >&2
        say "the build failed; the whole log is build/build.log"
        exit 70
    fi
}
