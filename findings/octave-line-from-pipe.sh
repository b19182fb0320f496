#!/usr/bin/env bash
# Octave's fgetl() on a pipe returns a line only when the next line begins.
#
# Versions: Octave 7.3.0 (Debian 12, package 7.3.0-2).
# Likely guess: fgetl(stdin) returns as soon as a whole line has arrived, as fgets() of C and readline() of Python do.
# What happens: after the newline fgetl() reads one more character, to set feof() early. It therefore waits until the
#   sender writes again or closes the pipe. Both programs wait indefinitely if the sender waits for an answer.
#   input('', 's') returns the line immediately.
# Who meets it: authors of programs that control Octave with one line per command and one line per answer.
#
# Output seen:
#   Octave 7.3.0
#   fgetl: first came the second line
#   input: first came the answer
#
# Exits with 1 if Octave behaves differently. Needs apt with sources of Debian 12 and about 80 MB from a Debian mirror;
# needs no privileges.
set -euo pipefail
version=7.3.0-2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap '' PIPE  # a reader that has answered has exited before the second line is sent
cd "$folder"

mkdir -p packages root cache/partial
apt-get install --print-uris -qq -y --no-install-recommends -o Dir::State::status=/dev/null \
  -o Dir::Cache::archives="$folder/cache" "octave=$version" |
  awk '/^\x27/ {gsub(/\x27/, "", $1); print $1}' >addresses
[ -s addresses ] || { echo "apt has no octave=$version. Run this on Debian 12." >&2; exit 1; }
while read -r address; do
  (cd packages && /usr/lib/apt/apt-helper -qq download-file "$address" "$(basename "$address")") 2>/dev/null
done <addresses
for package in packages/*.deb; do dpkg-deb -x "$package" root; done

libraries=$(find root -name '*.so*' -printf "$folder/%h\n" | sort -u | paste -sd:)
run_octave() {
  OCTAVE_HOME=$folder/root/usr root/lib/x86_64-linux-gnu/ld-linux-x86-64.so.2 --library-path "$libraries" \
    root/usr/bin/octave-cli --norc --quiet --no-history --eval "$1"
}

# Prints the earlier event: the answer to the first line, or the second line of the sender.
who_is_first() {
  mkfifo lines
  run_octave "line = $1; printf('answer\n'); fflush(stdout);" <lines >order 2>/dev/null &
  exec 3>lines
  echo first >&3
  # Octave starts within seconds. A reader that waits for another line never answers.
  for _ in $(seq 150); do
    ! grep -q answer order || break
    sleep 0.1
  done
  grep -q answer order && first="the answer" || first="the second line"
  echo second >&3 2>/dev/null || true
  exec 3>&-
  wait
  rm lines
  echo "$first"
}

run_octave 'printf("Octave %s\n", version())'
with_fgetl=$(who_is_first 'fgetl(stdin)')
with_input=$(who_is_first "input('', 's')")
echo "fgetl: first came $with_fgetl"
echo "input: first came $with_input"
[ "$with_fgetl" = "the second line" ] && [ "$with_input" = "the answer" ]
