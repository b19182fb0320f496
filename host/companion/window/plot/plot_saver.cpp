#include "host/companion/window/plot/plot_saver.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/widgets.hpp"

namespace inkwell::window {

std::optional<PlotFormat> choose_plot_format() {
  std::optional<PlotFormat> chosen;
  const auto offer = [&](const char* label, PlotFormat format) {
    if (ImGui::Selectable(label)) chosen = format;
    note_item(label);
  };
  offer("Save picture (PNG)", PlotFormat::png);
  offer("Save drawing (SVG)", PlotFormat::svg);
  offer("Save values (CSV)", PlotFormat::csv);
  return chosen;
}

void PlotSaver::ask(PlotFormat format, std::size_t index, const std::string& title,
                    const std::function<PlotTable()>& table) {
  if (writer_.is_running()) return;
  format_ = format;
  index_ = index;
  if (format != PlotFormat::png) table_ = table();
  static constexpr std::array<const char*, 3> endings{".png", ".svg", ".csv"};
  const char* ending = endings[static_cast<std::size_t>(format)];
  chooser_.ask({.title = "Save the plot",
                .help = format == PlotFormat::csv
                            ? "The file contains all displayed values, with the names and units of recordings."
                            : "The file contains the displayed section.",
                .button = "Save",
                .endings = {ending},
                .is_new_file = true,
                .suggestion = title + ending});
}

void PlotSaver::save(const std::filesystem::path& file) {
  file_ = file;
  if (format_ == PlotFormat::png) {
    picture_ = file;
    frames_to_wait_ = 3;
  } else {
    writer_.start([file, table = std::move(table_), is_csv = format_ == PlotFormat::csv] {
      return write_file(file, is_csv ? csv_of(table) : svg_of(table, light_palette));
    });
  }
}

void PlotSaver::draw(const char* name, float bottom, const Style& style) {
  if (frames_to_wait_ > 0) --frames_to_wait_;
  if (const auto chosen = chooser_.draw(style)) save(*chosen);
  if (const auto result = writer_.take_result()) {
    show(result->empty() ? fmt::format("Saved {}.", file_.string()) : *result);
    is_error_ = !result->empty();
  }
  constexpr double shown_s = 6.0;
  if (!is_error_ && ImGui::GetTime() - message_since_s_ > shown_s) message_.clear();
  if (message_.empty()) return;
  if (message_at_bottom(name, bottom, is_error_ ? style.palette->caution : style.palette->outline, message_, style))
    message_.clear();
}

void PlotSaver::show(std::string message) {
  message_ = std::move(message);
  is_error_ = false;
  message_since_s_ = ImGui::GetTime();
}

std::optional<Box> PlotSaver::wanted_picture() const {
  if (!picture_ || frames_to_wait_ > 0 || index_ >= areas_.size()) return std::nullopt;
  return areas_[index_];
}

void PlotSaver::take_picture(Pixels pixels) {
  writer_.start(
      [file = *std::exchange(picture_, std::nullopt), pixels = std::move(pixels)] { return write_png(file, pixels); });
}

}  // namespace inkwell::window
