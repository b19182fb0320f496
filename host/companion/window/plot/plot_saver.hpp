// Saves plots as pictures, drawings or tables in files that the user chooses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/companion/window/frame/background_task.hpp"
#include "host/companion/window/frame/file_chooser.hpp"
#include "host/companion/window/frame/picture_changes.hpp"
#include "host/companion/window/frame/pixels.hpp"
#include "host/companion/window/frame/style.hpp"
#include "host/companion/window/plot/plot_export.hpp"

namespace inkwell::window {

enum class PlotFormat : std::uint8_t { png, svg, csv };

/// Draws a row for each format into the open menu. Returns the chosen format.
std::optional<PlotFormat> choose_plot_format();

class PlotSaver {
 public:
  /// Asks the user for the file of a plot. `index`: position of the plot in the last set_areas(). `table` returns the
  /// displayed values. The function does nothing while a file is written.
  void ask(PlotFormat format, std::size_t index, const std::string& title, const std::function<PlotTable()>& table);
  /// Sets the screen areas of all plots in this frame.
  void set_areas(std::vector<Box> areas) { areas_ = std::move(areas); }
  /// Draws the dialog, and the message about the last file above `bottom`. Call once per frame. `name`: name of the
  /// message in inspections.
  void draw(const char* name, float bottom, const Style& style);
  /// Shows a message for some seconds.
  void show(std::string message);

  /// Returns the area of a plot that must be saved as a picture; empty without a request. The frame must be drawn.
  std::optional<Box> wanted_picture() const;
  /// Saves the requested picture in the background.
  void take_picture(Pixels pixels);
  /// Returns true while a file is written or a picture is requested.
  bool is_saving() const { return picture_ || writer_.is_running(); }

 private:
  void save(const std::filesystem::path& file);

  PlotFormat format_ = PlotFormat::png;
  FileChooser chooser_;
  PlotTable table_;        ///< values at the time of the choice
  std::size_t index_ = 0;  ///< of the saved plot
  std::vector<Box> areas_;
  std::optional<std::filesystem::path> picture_;  ///< picture that is requested from the frame loop
  int frames_to_wait_ = 0;                        ///< until the dialog has disappeared from the screen
  BackgroundTask writer_;
  std::filesystem::path file_;  ///< last file
  std::string message_;         ///< empty: no message
  bool is_error_ = false;
  double message_since_s_ = 0.0;
};

}  // namespace inkwell::window
