#include "host/companion/window/window.hpp"

#include <cstdio>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <malloc.h>

#include "host/client/local/output.hpp"

#include "host/companion/window/frame/display.hpp"
#include "host/companion/window/frame/frame_loop.hpp"
#include "host/companion/window/frame/imgui_frames.hpp"
#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/window_settings.hpp"
#include "protocol/plain_text.hpp"

#include "host/companion/window/companion.hpp"

namespace inkwell::window {

namespace {

WindowSettings settings_at_start(const WindowOptions& options, const WindowSettings& read) {
  WindowSettings settings = read;
  if (options.theme) settings.theme = *options.theme;
  if (options.layout.empty()) return settings;
  const ScopeLayout* layout = find_layout(options.layout, settings.scope.own_layouts);
  if (layout == nullptr)
    throw std::runtime_error(fmt::format("The layout {} does not exist. Choose a layout with --layout: {}.",
                                         options.layout, layout_names(settings.scope.own_layouts)));
  settings.scope.layout = *layout;
  return settings;
}

WindowSettings stored_settings(const WindowOptions& options) {
  if (!options.persist_settings) return {};
  const LoadedSettings loaded = read_settings(window_settings_path());
  if (!loaded.problem.empty()) local::print_error("{}\n", protocol::plain_lines(loaded.problem));
  return loaded.settings;
}

void keep(const WindowSettings& settings, const WindowSettings& before) {
  const auto file = window_settings_path();
  if (file.empty()) return;
  const std::string problem = write_settings(settings, file, before);
  if (!problem.empty()) local::print_error("{}\n", problem);
}

/// Returns an error message; empty on success.
std::string start_virtual_board(WindowOptions& options) {
  try {
    options.start_virtual_board(options);
    return {};
  } catch (const device::Error& error) {
    return error.what();
  }
}

void run(WindowOptions options) {
  const WindowSettings read = stored_settings(options);
  WindowSettings settings = settings_at_start(options, read);
  end_loop_at_signals();
  Display display({options.width, options.height}, options.scale, "Inkwell");
  std::optional<Inspection> inspection;  // outlives the frame loops, so that no request is lost between two loops
  if (options.inspect) inspection.emplace(&Display::wake);
  for (std::string problem;;) {
    ImGuiFrames imgui(display.handle());
    Companion companion(options, settings, display.scale(), problem);
    FrameLoop(display, imgui, companion,
              {.screenshot = options.screenshot,
               .after_seconds = options.after_seconds,
               .inspection = inspection ? &*inspection : nullptr,
               .frames_report = options.frames_report})
        .run();
    settings = companion.settings();
    if (!companion.is_over()) break;
    problem = start_virtual_board(options);
  }
  if (options.persist_settings) keep(settings, read);
}

/// Each frame allocates and frees some megabytes. Retaining the memory prevents page faults, which would take a third
/// of the frame preparation time.
void keep_memory_between_frames() {
  constexpr int kept_bytes = 64 << 20;
  mallopt(M_TRIM_THRESHOLD, kept_bytes);
  mallopt(M_MMAP_THRESHOLD, kept_bytes);
}

}  // namespace

int run_window(const WindowOptions& options) {
  keep_memory_between_frames();
  try {
    run(options);
    return 0;
  } catch (const std::exception& error) {
    local::print_error("{}\n", error.what());
    return 1;
  }
}

}  // namespace inkwell::window
