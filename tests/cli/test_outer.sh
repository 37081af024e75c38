#!/usr/bin/env bash
# Commands that another program does: where it is found, what it is given, and what is said if it cannot run. Prints TAP.
# Needs: UNCROSS, the program (default build/uncross). A script stands for the other program, so no Python is needed.
set -u
uncross=$(realpath "${UNCROSS:-build/uncross}")
dir=$(realpath "$(mktemp -d)")
trap 'rm -rf "$dir"' EXIT
count=0
failures=0

ok() { # ok STATUS NAME
  count=$((count + 1))
  if [ "$1" = 0 ]; then echo "ok $count - $2"; else echo "not ok $count - $2"; failures=$((failures + 1)); fi
}
gives() { # gives CODE TEXT PROGRAM ARGUMENTS ...: the exit code, and a line of standard output or error
  local wanted=$1 text=$2 code
  shift 2
  "$@" >"$dir/out" 2>&1
  code=$?
  { [ "$code" = "$wanted" ] && grep -qxF -- "$text" "$dir/out" && [ "$(wc -l <"$dir/out")" = 1 ]; }
  ok $? "${*//"$dir"\//}: $code, $text"
}

# A build folder has its own libexec, an installed program that of its prefix. What else stands beside a program is nobody's.
mkdir -p "$dir"/{tree/build/libexec,tree/tools,tree/bin/libexec,tree/libexec/uncross,prefix/bin,prefix/libexec/uncross,alone/bin,libexec/uncross}
for place in tree/build tree/bin tree/tools prefix/bin alone/bin; do cp "$uncross" "$dir/$place/uncross"; done
# shellcheck disable=SC2016 # the script expands it
script='#!/bin/sh
echo "$UNCROSS" "$@" /
exit 7'
for place in tree/build/libexec tree/bin/libexec prefix/libexec/uncross; do echo "$script" >"$dir/$place/uncross-plot"; done
for place in tree/tools tree/libexec/uncross libexec/uncross tree; do echo 'echo planted' >"$dir/$place/uncross-plot"; done
find "$dir" -name uncross-plot -exec chmod +x {} +

gives 7 "$dir/tree/build/uncross one two words /" "$dir/tree/build/uncross" plot one 'two words'
gives 7 "$dir/tree/bin/uncross --movie --out=x one /" "$dir/tree/bin/uncross" plot one --movie --out=x
gives 7 "$dir/prefix/bin/uncross --compare -- one -two /" "$dir/prefix/bin/uncross" plot --compare -- one -two
ln -s "$dir/prefix/bin/uncross" "$dir/alone/link"
gives 7 "$dir/prefix/bin/uncross one /" "$dir/alone/link" plot one
none="uncross: plot: there is no program uncross-plot: make puts it into libexec/ beside the program, make install into ../libexec/uncross"
gives 1 "$none" "$dir/alone/bin/uncross" plot one
gives 1 "$none" "$dir/tree/tools/uncross" plot one
rm "$dir/tree/build/libexec/uncross-plot"
gives 1 "$none" "$dir/tree/build/uncross" plot one
cp "$dir/prefix/libexec/uncross/uncross-plot" "$dir/tree/build/libexec/"
chmod -x "$dir/prefix/libexec/uncross/uncross-plot"
gives 1 "$none" "$dir/prefix/bin/uncross" plot one
sed -i '1s|.*|#!/nowhere/python3|' "$dir/tree/build/libexec/uncross-plot"
"$dir/tree/build/uncross" plot one >"$dir/out" 2>&1
[ $? = 1 ] && grep -qF "there is no /usr/bin/python3; \`apt-get install python3\` installs it" "$dir/out"
ok $? "an interpreter that is not there: 1, and the command that installs it"
gives 2 "uncross: plot: a file is missing; \`uncross plot --help\` lists what is allowed" "$dir/alone/bin/uncross" plot
"$dir/alone/bin/uncross" plot one --fly >"$dir/out" 2>&1
[ $? = 2 ] && grep -q 'unrecognized option' "$dir/out"
ok $? "an option that is none: 2, before the other program is looked for"
"$dir/alone/bin/uncross" plot --help | grep -q '^  --movie '
ok $? "help needs no other program"
echo "1..$count"
exit $((failures > 0))
