#include "host/companion/window/panes/registry.hpp"

// Functions that create the panes, in the order of the tabs. Each function has the name of its .cpp file.
#define INKWELL_PANES(PANE) \
  PANE(tuning_pane)         \
  PANE(guides_pane)         \
  PANE(recording_pane)      \
  PANE(faults_pane)         \
  PANE(log_pane)

namespace inkwell::window {

#define INKWELL_DECLARE(pane) std::unique_ptr<Pane> pane(const PaneSurroundings& around);
INKWELL_PANES(INKWELL_DECLARE)
#undef INKWELL_DECLARE

std::vector<std::unique_ptr<Pane>> make_panes(const PaneSurroundings& around) {
  std::vector<std::unique_ptr<Pane>> panes;
#define INKWELL_MAKE(pane) panes.push_back(pane(around));
  INKWELL_PANES(INKWELL_MAKE)
#undef INKWELL_MAKE
  return panes;
}

}  // namespace inkwell::window
