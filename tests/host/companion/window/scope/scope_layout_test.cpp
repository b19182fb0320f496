#include <doctest/doctest.h>

#include "host/companion/window/scope/scope_layout.hpp"
#include "protocol/reports.hpp"

using namespace inkwell;
using namespace inkwell::window;

TEST_CASE("layouts name existing signals, and fit into one selection") {
  for (const ScopeLayout& layout : built_in_layouts()) {
    CAPTURE(layout.name);
    CHECK_FALSE(layout.plots.empty());
    CHECK(signals_of(layout).size() <= protocol::scope_signals_maximum);
  }
  CHECK(built_in_layout("paper").plots.size() == 4);
  CHECK(built_in_layout("none of them").name == built_in_layouts().front().name);
}

TEST_CASE("custom layouts can be saved, replaced, renamed and removed, and built-in layouts do not change") {
  OwnLayouts own;
  ScopeLayout layout = built_in_layout("currents");
  layout.name = "mine";
  own.save(layout);
  layout.columns = 1;
  own.save(layout);
  REQUIRE(own.all().size() == 1);
  CHECK(layout_named("mine", own).columns == 1);
  CHECK(layout_named("paper", own) == built_in_layout("paper"));

  CHECK_FALSE(OwnLayouts::refusal("paper").empty());
  CHECK_FALSE(OwnLayouts::refusal("  ").empty());
  CHECK(OwnLayouts::refusal("mine").empty());
  layout.name = "other";
  own.save(layout);
  CHECK_FALSE(own.rename("other", "mine").empty());
  CHECK_FALSE(own.rename("other", "paper").empty());
  CHECK(own.rename("other", "third").empty());
  CHECK(own.find("other") == nullptr);
  REQUIRE(own.find("third") != nullptr);
  own.remove("third");
  CHECK(own.all().size() == 1);
  CHECK(built_in_layout("paper").plots.size() == 4);

  layout.name = "paper";  // from a file that a user edited
  CHECK(OwnLayouts({layout}).all().empty());
}

TEST_CASE("a layout with too many signals requests the maximum number of signals, each once") {
  ScopeLayout layout{"all", 2, {{PlotKind::time, "a", {}}, {PlotKind::time, "b", {}}}};
  for (const auto& info : protocol::signal_table)
    for (ScopePlot& plot : layout.plots) plot.signals.push_back(static_cast<protocol::Signal>(info.id));
  CHECK(signals_of(layout).size() == protocol::scope_signals_maximum);
}
