#!/usr/bin/env bash
# Packages in bare Debian systems: the steps of packaging/Containerfile, which build all packages in one root and install them in
# another, where the tests of packaging/debian/tests run. The packages have the bytes of those that are made here, in another folder.
# Needs root, debootstrap and a clone, else it is skipped; then a mirror, as apt has it; BUILD (default build). Prints TAP.
set -u
build=$(realpath "${BUILD:-build}")
top=$(cd "$(dirname "$0")/../.." && pwd)
count=0
failures=0
ok() { # ok STATUS NAME
  count=$((count + 1))
  if [ "$1" = 0 ]; then echo "ok $count - $2"; else echo "not ok $count - $2"; failures=$((failures + 1)); fi
}

if [ "$(id -u)" != 0 ] || ! command -v debootstrap >/dev/null || ! git -C "$top" rev-parse HEAD >/dev/null 2>&1; then
  echo "ok 1 # SKIP needs root, debootstrap and a clone"
  echo "1..1"
  exit 0
fi
dir=$(mktemp -d -p "$build")
trap 'rm -rf --one-file-system "$dir"' EXIT
cd "$top" || exit 1

git clone -q "$top" "$dir/context"
git -C "$dir/context" checkout -q "$(git rev-parse HEAD)"
packaging/run-steps packaging/Containerfile "$dir/context" "$dir/roots" >"$dir/log" 2>&1 || tail -n 40 "$dir/log"
uncross=$dir/roots/last/usr/bin/uncross
[ -x "$uncross" ]
ok $? "the steps of the container file end with an installed program"

mkdir "$dir/roots/last/tree"
cp -r packaging/debian/tests scenes "$dir/roots/last/tree"
mkdir "$dir/roots/last/tree/tests/kernel"
cp tests/kernel/shipped.txt "$dir/roots/last/tree/tests/kernel"
within() { # a command in the installed root
  # shellcheck disable=SC2016 # the inner shell expands them
  unshare --mount --pid --fork sh -ec 'mount -t proc proc "$1/proc"; exec chroot "$1" sh -ec "cd /tree && $2"' sh "$dir/roots/last" "$1"
}
for name in hash python; do
  within "tests/$name" | sed 's/^/# /'
  ok "${PIPESTATUS[0]}" "packaging/debian/tests/$name in the bare root"
done
within "apt-get -qq -y --no-install-recommends install gcc libc6-dev pkgconf >/dev/null 2>&1 && tests/library" | sed 's/^/# /'
ok "${PIPESTATUS[0]}" "packaging/debian/tests/library in the bare root"
mkdir "$dir/roots/last/tree/plotted"
printf 'time,g,g_error\n1,2,0.1\n2,3,0.1\n' >"$dir/roots/last/tree/plotted/solvent.csv"
within "uncross map length=10um,persistence=17um --units T=300K,eta=1mPas >/dev/null && uncross plot plotted/solvent.csv >/dev/null"
ok $? "commands in Python: map, plot"

make -s -C "$dir/context" dist BUILD=here >"$dir/log" 2>&1
packaging/make-deb "$dir"/context/here/dist/*.tar.gz "$dir/another-folder/here" >"$dir/log" 2>&1 || tail -n 40 "$dir/log"
(cd "$dir/another-folder/here" && sha256sum ./*.deb ./*.dsc) >"$dir/sums"
sed 's/^/# /' "$dir/sums"
[ "$(wc -l <"$dir/sums")" -ge 7 ] && (cd "$dir/roots/build/src/build/deb" && sha256sum -c --quiet) <"$dir/sums"
ok $? "the same bytes in another folder and another system"
echo "1..$count"
exit $((failures > 0))
