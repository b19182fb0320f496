// docs/dropins.md lists every function, and every parameter with its count, unit and meaning.
#include <doctest/doctest.h>

#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "host/bindings/dropins/parameters.hpp"

namespace inkwell::dropins {
namespace {

std::string read(const std::string& path) {
  std::ifstream file(std::string(INKWELL_SOURCE_DIRECTORY) + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_CASE("the document's list of parameters is that of the library") {
  const auto document = read("/docs/dropins.md");
  const auto writable = document.find("\n### Writable parameters\n");
  REQUIRE(writable != std::string::npos);
  std::string missing;
  for (const auto& row : parameter_table()) {
    const auto line = fmt::format("\n- `{}` ({}{}{}): {}\n", row.name, row.count, *row.unit != '\0' ? " " : "",
                                  row.unit, row.meaning);
    const auto position = document.find(line);
    if (position == std::string::npos || (position > writable) != (row.write != nullptr)) missing += line;
  }
  CHECK_MESSAGE(missing.empty(), missing);
}

TEST_CASE("the document names every function") {
  const auto document = read("/docs/dropins.md");
  for (const auto header : {"/host/bindings/dropins/hd_interface.hpp", "/host/bindings/dropins/hd_phantom.cpp"}) {
    const auto text = read(header);
    REQUIRE(text.size() > 1000);
    for (auto position = text.find("\nINKWELL_HD "); position != std::string::npos;
         position = text.find("\nINKWELL_HD ", position + 1)) {
      const auto end = text.find('(', position);
      const auto name = text.substr(text.rfind(' ', end) + 1, end - text.rfind(' ', end) - 1);
      CHECK_MESSAGE(document.find(name) != std::string::npos, name);
    }
  }
}

TEST_CASE("no value occurs twice in the table") {
  for (const auto& row : parameter_table()) {
    CHECK(find_parameter(row.value)->row == &row);
    if (row.last != 0) CHECK(find_parameter(row.last)->row == &row);
    CHECK((row.read != nullptr || row.text != nullptr));
    CHECK(row.count <= values_maximum);
  }
}

}  // namespace
}  // namespace inkwell::dropins
