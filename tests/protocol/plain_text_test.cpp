#include <doctest/doctest.h>

#include "protocol/plain_text.hpp"

using namespace inkwell::protocol;

TEST_CASE("plain_text does not change printable text of any script") {
  for (const char* text : {"", "PHANTOM Omni", "it's \"quoted\" `here` \\ $ % @ #", "Ärm, 腕, \xF0\x9F\xA6\xBE",
                           "\xC2\xA0", "\xE2\x80\x93 dash"}) {
    CHECK(plain_text(text) == text);
    CHECK(plain_lines(text) == text);
  }
}

TEST_CASE("control characters and broken UTF-8 are replaced byte by byte") {
  for (int c = 0; c < 0x20; ++c) {
    const bool is_space = c == '\t' || c == '\n' || c == '\r';
    CHECK(plain_text(std::string("a") + static_cast<char>(c) + "b") == (is_space ? "a b" : "a?b"));
  }
  CHECK(plain_text("\x7F") == "?");
  CHECK(plain_text("\x1B[31mred") == "?[31mred");
  for (const char* hostile : {"\xC2\x80", "\xC2\x9B", "\xC2\x9F", "\x9B\x9D", "\xC0\x8A", "\xC1\xBF", "\xFF\xFE"})
    CHECK(plain_text(hostile) == "??");
  for (const char* hostile :
       {"\xE2\x80\xA8", "\xE2\x80\xAA", "\xE2\x80\xAE", "\xE2\x81\xA6", "\xE2\x81\xA9", "\xED\xA0\x80", "\xE0\x82\x9B"})
    CHECK(plain_text(hostile) == "???");
  for (const char* hostile : {"\xF4\x90\x80\x80", "\xF0\x80\x82\x9B", "\xF8\x80\x80\x80"})
    CHECK(plain_text(hostile) == "????");
  CHECK(plain_text("\xE2\x82") == "??");  // the euro sign, truncated
  CHECK(plain_text("\xE2\x82x") == "??x");
  CHECK(plain_text(std::string_view("\0\xC3", 2)) == "??");
}

TEST_CASE("plain_lines retains only line ends and tabs among the control characters") {
  CHECK(plain_lines("one\n\ttwo\r\n\x1B]0;title\x07\n") == "one\n\ttwo \n?]0;title?\n");
}
