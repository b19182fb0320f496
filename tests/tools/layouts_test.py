"""What tools/generate/generate_layouts.py makes of a header, and that it takes no line of a structure for nothing."""

import subprocess
import sys
import tempfile
from pathlib import Path

HEADER = """// What it is about.
#pragma once

/// Two things.
enum class Kind : std::uint8_t {
  one = 1,  ///< the first
  two = 2,
};

inline constexpr std::size_t rows_maximum = 3;  ///< of them

/// A report,
/// in two lines.
struct Report {
  Kind kind = Kind::one;
  std::uint8_t low : 3;  ///< the low bits
  std::uint8_t high : 5;
  float values_N[rows_maximum];
};
"""


def generate(header: str) -> subprocess.CompletedProcess:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "made_up.hpp")
        file.write_text(header)
        return subprocess.run([sys.executable, Path(sys.argv[1]) / "tools/generate/generate_layouts.py", file],
                              capture_output=True, text=True)


made = generate(HEADER)
assert made.returncode == 0, made.stderr
for row in ('{R"~(Kind)~", R"~(kind)~", offsetof(Report, kind), sizeof(Report::kind), 0, 0, 0, R"~(Kind::one)~", R"~()~"},',
            '{R"~(uint8)~", R"~(low)~", offsetof(Report, kind) + sizeof(Report::kind) + 0, 1, 0, 0, 3, R"~()~", '
            'R"~(the low bits)~"},',
            '{R"~(uint8)~", R"~(high)~", offsetof(Report, kind) + sizeof(Report::kind) + 0, 1, 0, 3, 5, R"~()~", R"~()~"},',
            '{R"~(Report)~", sizeof(Report), R"~(A report, in two lines.)~", fields_of_Report},',
            '{R"~(one)~", static_cast<unsigned>(Kind::one), R"~(the first)~"},',
            '{R"~(rows_maximum)~", static_cast<double>(rows_maximum), R"~(of them)~"},',
            '{R"~(made_up.hpp)~", R"~(What it is about.)~"},'):
    assert row in made.stdout, f"{row}\nis not in\n{made.stdout}"

for wrong in "  float* pointer;", "  float x, y;", "  void act();":
    refused = generate(HEADER.replace("  Kind kind", wrong + "\n  Kind kind"))
    assert refused.returncode != 0 and "made_up.hpp: Report: " + wrong.strip() in refused.stderr, refused
