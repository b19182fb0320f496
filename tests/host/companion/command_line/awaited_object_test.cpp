#include <doctest/doctest.h>

#include <thread>

#include "host/companion/command_line/awaited_object.hpp"

using namespace inkwell;
using command_line::AwaitedObject;

namespace {

constexpr geometry::Box workspace{{-0.08f, -0.09f, -0.09f}, {0.08f, 0.09f, 0.04f}};

}  // namespace

TEST_CASE("an awaited object reports step and percentage, and is adopted once") {
  // A busy computer may load an object before the first question.
  window::ObjectLoading first;
  for (int attempt = 0; attempt < 200 && first.progress.empty(); ++attempt) {
    feel::Loading loading({.example = "ball", .workspace = workspace});
    int adopted = 0;
    AwaitedObject awaited(loading, [&](const feel::LoadedObject& loaded) { adopted += loaded.name == "ball"; });
    first = awaited.follow();
    while (!awaited.object()) {
      std::this_thread::yield();
      awaited.follow();
    }
    CHECK(awaited.follow() == window::ObjectLoading{});
    CHECK(adopted == 1);
  }
  CHECK(first.progress.starts_with("loading ball: "));
  CHECK(first.progress.ends_with(" %"));
}

TEST_CASE("an awaited object that cannot be used reports its problem") {
  feel::Loading loading({.file = "/nowhere/skull.stl", .workspace = workspace});
  AwaitedObject awaited(loading, [](const feel::LoadedObject&) { FAIL("the load has failed"); });
  while (awaited.problem().empty()) {
    std::this_thread::yield();
    awaited.follow();
  }
  CHECK_FALSE(awaited.object());
  CHECK(awaited.follow().progress.empty());
  CHECK(awaited.follow().problem.starts_with("skull.stl cannot be opened"));
}
