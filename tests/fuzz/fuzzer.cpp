// Connects one fuzz target to libFuzzer; main() is part of libFuzzer.
// `inkwell-fuzz TARGET [libFuzzer's options] [FOLDER...]` fuzzes and saves inputs that reach new code in FOLDER.
// `inkwell-fuzz --list` prints the targets.
// `inkwell-fuzz --seeds TARGET FOLDER` writes the target's seeds as raw input.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>

#include "tests/fuzz/seeds.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace inkwell;

const fuzz::Target* chosen = nullptr;

[[noreturn]] void end(int code, const std::string& sentence) {
  std::fprintf(stderr, "%s\n", sentence.c_str());
  std::exit(code);
}

const fuzz::Target& target_named(const std::string& name) {
  if (const auto* target = fuzz::find(name)) return *target;
  end(2, "There is no target \"" + name + "\"; inkwell-fuzz --list shows them.");
}

void write_seeds(const std::string& target, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const auto& seed : fuzz::seeds_of(target_named(target)))
    std::ofstream(folder / seed.name, std::ios::binary)
        .write(reinterpret_cast<const char*>(seed.bytes.data()), static_cast<std::streamsize>(seed.bytes.size()));
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** words) {
  // The fake port uses doctest checks, which need a context outside a test case.
  static doctest::Context context;
  context.setAsDefaultForAssertsOutOfTestCases();
  context.setAssertHandler([](const doctest::AssertData& failed) {
    std::fprintf(stderr, "%s:%d: %s does not hold\n", failed.m_file, failed.m_line, failed.m_expr);
    std::abort();
  });

  const std::vector<std::string> arguments(*words + 1, *words + *count);
  if (arguments.size() == 1 && arguments[0] == "--list") {
    for (const auto& target : fuzz::targets()) std::printf("%s\n", std::string(target.name).c_str());
    std::exit(0);
  }
  if (arguments.size() == 3 && arguments[0] == "--seeds") {
    write_seeds(arguments[1], arguments[2]);
    std::exit(0);
  }
  if (arguments.empty()) end(2, "Name a target; inkwell-fuzz --list shows them.");
  chosen = &target_named(arguments[0]);
  (*words)[1] = (*words)[0];  // removes the target from libFuzzer's arguments
  ++*words;
  --*count;

  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen->run(std::as_bytes(std::span(data, size)));
  return 0;
}
