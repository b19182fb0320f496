#include "tests/fuzz/seeds.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace inkwell::fuzz {
namespace {

Bytes decode(const std::string& text, const std::filesystem::path& file) {
  std::string digits;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    std::ranges::copy_if(line.substr(0, line.find('#')), std::back_inserter(digits), [](char c) { return c > ' '; });
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
    unsigned value = 0;
    const char* const end = digits.data() + i + 2;
    if (std::from_chars(digits.data() + i, end, value, 16).ptr != end) break;
    bytes.push_back(static_cast<std::byte>(value));
  }
  if (2 * bytes.size() != digits.size())
    throw std::runtime_error(file.string() + " holds something else than pairs of hexadecimal digits.");
  return bytes;
}

}  // namespace

Bytes contents_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error(file.string() + " cannot be read.");
  return bytes_of(std::string{std::istreambuf_iterator<char>(stream), {}});
}

std::vector<Seed> seeds_of(const Target& target) {
  std::vector<Seed> seeds;
  for (Bytes& example : target.examples())
    seeds.push_back({"example-" + std::to_string(seeds.size() + 1), std::move(example)});
  const std::filesystem::path folder =
      std::filesystem::path(INKWELL_SOURCE_DIRECTORY) / "tests/fuzz/seeds" / target.name;
  if (!std::filesystem::exists(folder)) return seeds;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const Bytes bytes = contents_of(entry.path());
    const bool is_hex = entry.path().extension() == ".hex";
    seeds.push_back({entry.path().filename().string(), is_hex ? decode(text_of(bytes), entry.path()) : bytes});
  }
  std::ranges::sort(seeds, {}, &Seed::name);
  return seeds;
}

}  // namespace inkwell::fuzz
