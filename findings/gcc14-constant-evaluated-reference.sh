#!/usr/bin/env bash
# GCC 14 evaluates the initializer of a reference as a constant, so std::is_constant_evaluated() is true at run time.
#
# Versions: GCC 14.2.0 (Debian 13, package g++-14 14.2.0-19), compared with GCC 12.2.0 (Debian 12, g++-12 12.2.0-14+deb12u1).
# Likely guess: in an ordinary function, a call outside of constexpr variables, array bounds and static_assert is evaluated
#   at run time, and std::is_constant_evaluated() is false. GCC 12 behaves as expected.
# What happens: a reference is usable in constant expressions if its initializer is constant. GCC 14 therefore first tries
#   to evaluate the initializer as a constant, and std::is_constant_evaluated() is true in this attempt. A range-based for
#   statement binds its range to a hidden reference, so the loop below runs over the constant table and never sees the row
#   that was added at run time. The call that initializes a value sees this row.
# Who meets it: authors of functions that return a constant table during compilation and a longer table at run time, and
#   users of GCC 14 with code that passed all tests with GCC 12.
#
# Output seen:
#   g++-12: value 2, reference 2, loop 2
#   g++-14: value 2, reference 1, loop 1
#
# Exits with 1 if a compiler behaves differently. Needs mmdebstrap, about 300 MB from Debian's mirror, and root or user
# namespaces.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

cat >rows.cpp <<'EOF'
#include <cstdio>
#include <span>
#include <type_traits>

int rows[] = {1, 2};              // the second row is known at run time only
constexpr int constant_rows[] = {1};

constexpr std::span<const int> known_rows() {
  if (std::is_constant_evaluated()) return constant_rows;
  return rows;
}

int main() {
  const std::span<const int> value = known_rows();
  const std::span<const int>& reference = known_rows();
  int in_loop = 0;
  for (const int row : known_rows()) in_loop += row != 0;
  std::printf("value %zu, reference %zu, loop %d\n", value.size(), reference.size(), in_loop);
}
EOF

# Prints the output of the program, compiled and run in a new Debian of the release.
run_with() {
  local release=$1 compiler=$2 version=$3
  mmdebstrap --quiet --variant=essential --format=null --include="$compiler=$version,libc6-dev" \
    --customize-hook='copy-in rows.cpp /tmp' \
    --customize-hook="chroot \"\$1\" sh -c '$compiler -std=c++20 -O2 /tmp/rows.cpp -o /tmp/rows && /tmp/rows >/tmp/$release'" \
    --customize-hook="copy-out /tmp/$release ." "$release" /dev/null >log 2>&1 ||
    { tail -n 5 log >&2; echo "No Debian $release with $compiler=$version could be made." >&2; exit 1; }
  echo "$compiler: $(cat "$release")"
}

result=$(run_with bookworm g++-12 12.2.0-14+deb12u1; run_with trixie g++-14 14.2.0-19)
echo "$result"
[ "$result" = "g++-12: value 2, reference 2, loop 2
g++-14: value 2, reference 1, loop 1" ]
