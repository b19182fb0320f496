// Runs the fuzzer's seeds in each test run, so that a corrected error cannot return.
#include <doctest/doctest.h>

#include "tests/fuzz/seeds.hpp"
#include "tests/fuzz/target.hpp"

using namespace inkwell;

TEST_CASE("every fuzz target accepts empty input, its seeds and truncated seeds without an exception") {
  CHECK(fuzz::targets().size() > 10);
  for (const fuzz::Target& target : fuzz::targets()) {
    CAPTURE(target.name);
    CHECK_NOTHROW(target.run({}));
    const auto seeds = fuzz::seeds_of(target);
    CHECK_FALSE(seeds.empty());
    for (const fuzz::Seed& seed : seeds) {
      CAPTURE(seed.name);
      CHECK_FALSE(seed.bytes.empty());
      const std::size_t step = 1 + seed.bytes.size() / 100;
      for (std::size_t length = 0; length < seed.bytes.size(); length += step)
        REQUIRE_NOTHROW(target.run(std::span(seed.bytes).first(length)));
      CHECK_NOTHROW(target.run(seed.bytes));
    }
  }
}

TEST_CASE("every fuzz target has a row in docs/fuzzing.md") {
  const std::string page = fuzz::text_of(fuzz::contents_of(INKWELL_SOURCE_DIRECTORY "/docs/fuzzing.md"));
  for (const fuzz::Target& target : fuzz::targets()) {
    CAPTURE(target.name);
    CHECK(page.find("\n| `" + std::string(target.name) + "` | ") != std::string::npos);
  }
  std::size_t rows = 0;
  for (std::size_t row = page.find("\n| `"); row != std::string::npos; row = page.find("\n| `", row + 1)) ++rows;
  CHECK(rows == fuzz::targets().size());
}
