// Tests the samples of a recording with a given length, and the number of missing samples at its end.
#include <doctest/doctest.h>

#include "host/companion/command_line/recorded_span.hpp"

using namespace inkwell;
using command_line::RecordedSpan;

namespace {

/// Number of samples of the block that belong to the recording.
std::size_t taken(RecordedSpan& span, std::int64_t first_period, std::size_t count) {
  device::ScopeSamples samples{};
  samples.first_period = first_period;
  samples.count = count;
  span.cut(samples);
  return samples.count;
}

}  // namespace

TEST_CASE("a recording of a given length stops after its last period, also if the board runs for days") {
  for (const std::int64_t first : {std::int64_t{7}, std::int64_t{5} << 32}) {
    CAPTURE(first);
    RecordedSpan span(100);
    CHECK(taken(span, first, 60) == 60);
    CHECK_FALSE(span.is_over());
    CHECK(taken(span, first + 60, 60) == 40);
    CHECK(span.is_over());
    CHECK(span.missing_at_end(100, 0) == 0);
  }
  RecordedSpan endless(0);
  CHECK(taken(endless, 7, 1'000'000) == 1'000'000);
  CHECK_FALSE(endless.is_over());
  CHECK(endless.missing_at_end(1'000'000, 0) == 0);
}

TEST_CASE("samples lost at the end of a recording count as missing, samples lost earlier do not") {
  RecordedSpan span(100);
  CHECK(taken(span, 7, 50) == 50);
  CHECK(taken(span, 7 + 60, 20) == 20);
  CHECK_FALSE(span.is_over());
  CHECK(span.missing_at_end(70, 10) == 0);  // a recording that was stopped early has no missing samples
  SUBCASE("the next samples are after the end") {
    CHECK(taken(span, 7 + 110, 20) == 0);
    CHECK(span.is_over());
    CHECK(span.missing_at_end(70, 10) == 20);
  }
  SUBCASE("the last samples arrive, but the recorder has no room for them") {
    CHECK(taken(span, 7 + 80, 20) == 20);
    CHECK(span.is_over());
    CHECK(span.missing_at_end(70, 10) == 20);
    CHECK(span.missing_at_end(90, 10) == 0);
  }
}

TEST_CASE("a restart of the board does not complete a recording") {
  RecordedSpan span(100);
  CHECK(taken(span, 1000, 50) == 50);
  CHECK(taken(span, 0, 20) == 20);  // the recorder must receive the samples of the restarted board
  CHECK_FALSE(span.is_over());
}

TEST_CASE("a recording may last days") {
  constexpr std::uint64_t periods = 3ull << 32;
  RecordedSpan span(periods);
  constexpr std::uint32_t block = 1u << 30;
  std::int64_t period = 5;
  for (int i = 0; i < 11; ++i, period += block) {
    CHECK(taken(span, period, block) == block);
    CHECK_FALSE(span.is_over());
  }
  CHECK(taken(span, period, block) == block);
  CHECK(span.is_over());
}
