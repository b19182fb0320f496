// List of all panes.
#pragma once

#include <memory>
#include <vector>

#include "host/companion/window/panes/pane.hpp"

namespace inkwell::window {

/// Creates all panes, in the order of the tabs.
std::vector<std::unique_ptr<Pane>> make_panes(const PaneSurroundings& around);

}  // namespace inkwell::window
