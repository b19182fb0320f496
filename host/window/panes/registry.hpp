// Which panes there are.
#pragma once

#include <memory>
#include <vector>

#include <panes/pane.hpp>

namespace inkwell::window {

/// One of each, in the order of their tabs.
std::vector<std::unique_ptr<Pane>> make_panes(const PaneSurroundings& around);

}  // namespace inkwell::window
