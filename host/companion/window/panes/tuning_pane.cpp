// The pane with one slider per parameter.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/client/device/parameter_file.hpp"
#include "host/companion/window/device_desk/stored_values.hpp"
#include "host/companion/window/frame/file_chooser.hpp"
#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/shown_unit.hpp"
#include "host/companion/window/frame/value_field.hpp"
#include "host/companion/window/frame/widgets.hpp"
#include "host/companion/window/panes/pane.hpp"
#include "host/companion/window/panes/refusal_text.hpp"

#include "host/companion/window/panes/store_bar.hpp"

namespace inkwell::window {

using device::ParameterChange;
using protocol::Parameter;
using protocol::ParameterKind;

namespace {

constexpr float unit_points = 46.0f;
constexpr float reset_points = 26.0f;
constexpr float rows_indent_points = 20.0f;  // aligns a row with the title text, which follows an arrow

std::array<const char*, 2> choice_names(Parameter parameter) {
  if (parameter == Parameter::transmission) return {"serial", "parallelogram"};
  if (parameter == Parameter::frame) return {"paper", "Omni"};
  return {"no", "yes"};
}

std::string help_of(const protocol::ParameterInfo& info) {
  return fmt::format("{}\n{}, default {:g}. In files: {}", info.help, range_text(info),
                     shown_unit(info.unit).factor * info.default_value, info.name);
}

/// Converts a displayed value to the unit of the parameter. Removes rounding errors of the conversion.
float in_unit(const protocol::ParameterInfo& info, float shown) {
  const double factor = static_cast<double>(shown_unit(info.unit).factor);
  return factor == 1.0 ? shown : *device::parse_number(fmt::format("{:.7g}", static_cast<double>(shown) / factor));
}

ValueRange range_of(const protocol::ParameterInfo& info) {
  const float factor = shown_unit(info.unit).factor;
  return {.minimum = factor * info.minimum,
          .maximum = factor * info.maximum,
          .decimals = std::max(0, decimals_of(info) - static_cast<int>(std::lround(std::log10(factor)))),
          .logarithmic = info.minimum > 0.0f && info.maximum / info.minimum > 500.0f};
}

// Draws the arrow symbol with lines, because some fonts do not contain the symbol.
bool reset_button(const Style& style) {
  const float size = style.points(reset_points - 2);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const bool pressed = ImGui::InvisibleButton("reset", {size, ImGui::GetFrameHeight()});
  const ImVec2 centre{corner.x + 0.5f * size, corner.y + 0.5f * ImGui::GetFrameHeight()};
  const float radius = style.points(4.6f);
  const ImU32 colour = packed(ImGui::IsItemHovered() ? style.palette->text : style.palette->text_quiet);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PathArcTo(centre, radius, -2.2f, 2.4f, 14);
  list.PathStroke(colour, 0, style.points(1.4f));
  const ImVec2 tip{centre.x + radius * -0.59f, centre.y + radius * -0.81f};
  list.AddTriangleFilled({tip.x - style.points(3.2f), tip.y + style.points(1.2f)},
                         {tip.x + style.points(1.8f), tip.y + style.points(2.6f)},
                         {tip.x - style.points(0.6f), tip.y - style.points(3.2f)}, colour);
  return pressed;
}

class TuningPane final : public Pane {
 public:
  explicit TuningPane(const PaneSurroundings& around)
      : desk_(around.desk),
        store_bar_(around.desk),
        file_(around.parameters_file),
        has_own_board_(around.simulated_arm.has_value()),
        to_send_(around.parameters_to_send) {}

  std::string_view title() const override { return "Tuning"; }
  void follow(const PaneNews& news) override;
  void draw(const PaneFrame& frame) override;
  bool has_values_to_store() const override { return !not_stored(desk_.view()).empty(); }

 private:
  enum class FileTask : std::uint8_t { load, save };

  void draw_heading(const PaneFrame& frame);
  void draw_presets(const PaneFrame& frame);
  void draw_messages(const PaneFrame& frame, float bottom);
  /// Shows an error of this parameter below its field. Returns false without an error.
  bool draw_field_error(Parameter parameter, const PaneFrame& frame);
  /// Returns the refusal of the device, unless the user has closed the message.
  std::string refusal() const;
  void draw_group(std::string_view group, const PaneFrame& frame);
  void draw_row(Parameter parameter, const PaneFrame& frame);
  void draw_choice(Parameter parameter, const std::string& label, float width, const PaneFrame& frame);
  void draw_number(Parameter parameter, const std::string& label, float width, const PaneFrame& frame);
  /// Forgets the messages about earlier edits. The device's next refusal is about `parameter`, if any.
  void note_edit(std::optional<Parameter> parameter);
  /// Sends the typed value, or shows an error.
  void take_typed(Parameter parameter, const std::string& label, const std::string& typed, const PaneFrame& frame);
  void draw_file_dialog(const PaneFrame& frame);
  void choose_file(FileTask task);
  /// Loads a file as one undo step and shows the result in the pane.
  void load(const std::filesystem::path& file, ParameterEditor& editor, double now_s);
  /// Draws a question if a file would overwrite values that belong to one arm.
  void draw_question(const PaneFrame& frame);
  void send(const device::ParameterFile& loaded, ParameterEditor& editor, double now_s);
  void save(const std::filesystem::path& file, const ParameterEditor& editor);

  DeviceDesk& desk_;
  StoreBar store_bar_;
  std::vector<Parameter> not_stored_;             ///< in this frame
  std::filesystem::path& file_;                   ///< last file that was loaded or saved
  std::optional<device::ParameterFile> waiting_;  ///< loaded from `file_`, waits for the user's agreement
  const bool has_own_board_;
  std::filesystem::path to_send_;  ///< sent once a device is connected; empty: none or already sent
  ValueFields fields_;
  FileTask task_ = FileTask::load;
  FileChooser chooser_;
  std::vector<std::string> messages_;  ///< about the last file
  bool message_is_error_ = false;      ///< true: the message remains until the user closes it
  double message_since_s_ = 0.0;
  struct FieldError {
    Parameter parameter;
    std::string sentence;
  };
  std::optional<FieldError> typing_error_;
  std::optional<Parameter> last_edited_;  ///< the device refuses at most this parameter
  std::string closed_refusal_;            ///< the user has closed this message
};

void TuningPane::follow(const PaneNews& news) {
  if (!to_send_.empty() && news.editor.known()) load(std::exchange(to_send_, {}), news.editor, news.now_s);
}

void TuningPane::load(const std::filesystem::path& file, ParameterEditor& editor, double now_s) {
  file_ = file;
  note_edit(std::nullopt);
  waiting_.reset();
  try {
    device::ParameterFile loaded = device::load_parameters(file);
    if (has_own_board_ || compare_arm(loaded, editor.shown()).empty())
      send(loaded, editor, now_s);
    else
      waiting_ = std::move(loaded);
  } catch (const device::Error& error) {
    messages_ = {error.what()};
    message_is_error_ = true;
  }
}

void TuningPane::send(const device::ParameterFile& loaded, ParameterEditor& editor, double now_s) {
  editor.apply("load " + file_.filename().string(), loaded.changes, now_s);
  messages_ = {fmt::format("Loaded {} values from {}.", loaded.changes.size(), file_.filename().string())};
  for (const std::string& name : loaded.unknown)
    messages_.push_back(fmt::format("The parameter {} is unknown in this version and was ignored.", name));
  message_is_error_ = !loaded.unknown.empty();
  message_since_s_ = ImGui::GetTime();
}

void TuningPane::draw_question(const PaneFrame& frame) {
  if (!waiting_ || !frame.editor.known()) return;
  const Style& style = frame.style;
  const auto differences = compare_arm(*waiting_, frame.editor.shown());
  std::string names;
  for (const auto& difference : differences)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", protocol::info(difference.parameter).name);
  const auto& information = desk_.view().status.information;
  ImGui::PushFont(style.fonts.caption);
  wrapped_text(
      style.palette->caution,
      fmt::format(
          "{} changes the arm's geometry, directions, motors or calibration. {} Values: {}.", file_.filename().string(),
          origin_text(waiting_->origin, information ? origin_of(*information) : device::ParameterOrigin{}), names));
  ImGui::PopFont();
  const bool agrees =
      coloured_button("Change arm", style.palette->caution, style.palette->pane, {style.points(110), 0});
  ImGui::SameLine();
  const bool cancels = button("Keep arm", {style.points(110), 0});
  if (agrees) send(*waiting_, frame.editor, frame.now_s);
  if (cancels) {
    messages_ = {"Nothing was loaded."};
    message_is_error_ = false;
    message_since_s_ = ImGui::GetTime();
  }
  if (agrees || cancels) waiting_.reset();
}

void TuningPane::save(const std::filesystem::path& file, const ParameterEditor& editor) {
  file_ = file;
  messages_.clear();
  try {
    const auto& information = desk_.view().status.information;
    device::save_parameters(file, editor.shown(), information ? origin_of(*information) : device::ParameterOrigin{});
    messages_ = {fmt::format("Saved all parameters to {}.", file.string())};
    message_is_error_ = false;
    message_since_s_ = ImGui::GetTime();
  } catch (const device::Error& error) {
    messages_ = {error.what()};
    message_is_error_ = true;
  }
}

void TuningPane::draw_heading(const PaneFrame& frame) {
  const Style& style = frame.style;
  ParameterEditor& editor = frame.editor;
  ImGui::AlignTextToFramePadding();
  text(style.fonts.strong, style.palette->text, "Tuning");
  ImGui::SameLine();
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{style.points(2), style.points(7)});
  ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMax().x - style.points(196));
  ImGui::BeginDisabled(!editor.known() || !editor.can_undo());
  if (quiet_button("Undo", style)) editor.undo(frame.now_s);
  ImGui::EndDisabled();
  if (editor.can_undo())
    help_on_hover("", fmt::format("Undoes the change: {}. Key: Ctrl+Z", editor.undo_title()), style);
  ImGui::SameLine();
  ImGui::BeginDisabled(!editor.known() || !editor.can_redo());
  if (quiet_button("Redo", style)) editor.redo(frame.now_s);
  ImGui::EndDisabled();
  if (editor.can_redo())
    help_on_hover("", fmt::format("Redoes the change: {}. Key: Ctrl+Shift+Z", editor.redo_title()), style);
  ImGui::SameLine();
  ImGui::BeginDisabled(!editor.known());
  if (quiet_button("Load", style)) choose_file(FileTask::load);
  ImGui::SameLine();
  if (quiet_button("Save", style)) choose_file(FileTask::save);
  ImGui::EndDisabled();
  ImGui::PopStyleVar();
}

void TuningPane::draw_presets(const PaneFrame& frame) {
  const Style& style = frame.style;
  ParameterEditor& editor = frame.editor;
  const auto all = presets();
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const auto count = static_cast<float>(all.size() + 1);
  const float width = (ImGui::GetContentRegionAvail().x - gap * (count - 1.0f)) / count;
  for (const Preset& preset : all) {
    const bool on = editor.known() && std::ranges::all_of(preset.changes, [&](const ParameterChange& change) {
                      return editor.shown(change.first) == change.second;
                    });
    if (toggle_button(std::string(preset.name).c_str(), on, style, {width, 0})) {
      note_edit(std::nullopt);
      editor.apply(std::string(preset.name), preset.changes, frame.now_s);
    }
    help_on_hover(preset.name, preset.help, style);
    ImGui::SameLine();
  }
  if (button("Defaults", {width, 0})) {
    std::vector<ParameterChange> changes;
    for (std::size_t i = 0; i < protocol::known_parameters().size(); ++i)
      changes.emplace_back(static_cast<Parameter>(i), protocol::known_parameters()[i].default_value);
    note_edit(std::nullopt);
    editor.apply("all defaults", changes, frame.now_s);
  }
  help_on_hover("Defaults", "Sets every parameter to its default. You can undo this change.", style);
}

std::string TuningPane::refusal() const {
  const std::string refusal = desk_.view().refusal.value_or("");
  return refusal == closed_refusal_ ? std::string() : refusal_text(refusal);
}

void TuningPane::draw_messages(const PaneFrame& frame, float bottom) {
  const Palette& palette = *frame.style.palette;
  constexpr double shown_s = 4.0;
  if (!message_is_error_ && ImGui::GetTime() - message_since_s_ > shown_s) messages_.clear();
  if (!messages_.empty()) {
    const std::string all = fmt::format("{}", fmt::join(messages_, "\n"));
    if (message_at_bottom("tuning message", bottom, message_is_error_ ? palette.caution : palette.outline, all,
                          frame.style))
      messages_.clear();
  }
  const std::string refused = frame.is_replay ? std::string() : refusal();
  if (refused.empty() || last_edited_) return;
  if (message_at_bottom("tuning refusal", bottom, palette.caution, refused, frame.style))
    closed_refusal_ = desk_.view().refusal.value_or("");
}

bool TuningPane::draw_field_error(Parameter parameter, const PaneFrame& frame) {
  const Palette& palette = *frame.style.palette;
  if (typing_error_ && typing_error_->parameter == parameter) {
    if (message_below_item("tuning message", palette.caution, typing_error_->sentence, frame.style))
      typing_error_.reset();
    return true;
  }
  const std::string refused = refusal();
  if (last_edited_ != parameter || frame.is_replay || refused.empty()) return false;
  if (message_below_item("tuning message", palette.caution, refused, frame.style))
    closed_refusal_ = desk_.view().refusal.value_or("");
  return true;
}

void TuningPane::draw_choice(Parameter parameter, const std::string& label, float width, const PaneFrame& frame) {
  int choice = frame.editor.shown(parameter) >= 0.5f ? 1 : 0;
  const auto names = choice_names(parameter);
  ImGui::SetNextItemWidth(width);
  if (ImGui::Combo("##value", &choice, names.data(), static_cast<int>(names.size()))) {
    const ParameterChange change{parameter, static_cast<float>(choice)};
    note_edit(parameter);
    frame.editor.apply(label, {&change, 1}, frame.now_s);
  }
  note_item(protocol::info(parameter).name);
  if (!draw_field_error(parameter, frame)) help_on_hover(label, help_of(protocol::info(parameter)), frame.style);
}

void TuningPane::draw_number(Parameter parameter, const std::string& label, float width, const PaneFrame& frame) {
  ParameterEditor& editor = frame.editor;
  const protocol::ParameterInfo& info = protocol::info(parameter);
  const float factor = shown_unit(info.unit).factor;
  const ValueEdit edit = fields_.draw("##value", std::string(info.name), factor * editor.shown(parameter),
                                      range_of(info), width, frame.style);
  if (edit.drag_begins) {
    editor.begin_step(label);
    note_edit(parameter);
  }
  if (edit.dragged_to) {
    const ParameterChange change{parameter, in_unit(info, *edit.dragged_to)};
    editor.edit({&change, 1}, frame.now_s);
  }
  if (edit.drag_ends) editor.end_step();
  if (edit.typed) take_typed(parameter, label, *edit.typed, frame);
  if (!draw_field_error(parameter, frame)) help_on_hover(label, help_of(info), frame.style);
}

void TuningPane::note_edit(std::optional<Parameter> parameter) {
  last_edited_ = parameter;
  typing_error_.reset();
  messages_.clear();
  closed_refusal_.clear();
}

void TuningPane::take_typed(Parameter parameter, const std::string& label, const std::string& typed,
                            const PaneFrame& frame) {
  note_edit(parameter);
  const protocol::ParameterInfo& info = protocol::info(parameter);
  const auto number = device::parse_number(typed);
  const float value = number ? in_unit(info, *number) : 0.0f;
  const bool is_whole = info.kind == ParameterKind::real || value == std::round(value);
  if (number && std::isfinite(value) && value >= info.minimum && value <= info.maximum && is_whole) {
    const ParameterChange change{parameter, value};
    frame.editor.apply(label, {&change, 1}, frame.now_s);
    return;
  }
  const bool has_comma = typed.find(',') != std::string::npos;
  const std::string problem = number ? "" : fmt::format("`{}` is not a number. ", typed);
  const char* remedy = has_comma ? " Use a decimal point and no commas." : is_whole ? "" : " Enter a whole number.";
  typing_error_ = {parameter, fmt::format("{}{}: {}.{} The field keeps its old value.", problem, full_label_of(info),
                                          range_text(info), remedy)};
}

void TuningPane::draw_row(Parameter parameter, const PaneFrame& frame) {
  const Style& style = frame.style;
  ParameterEditor& editor = frame.editor;
  const protocol::ParameterInfo& info = protocol::info(parameter);
  const Palette& palette = *style.palette;
  const bool changed = editor.known() && editor.differs_from_default(parameter);
  ImGui::PushID(static_cast<int>(parameter));

  const float left = ImGui::GetCursorPosX();
  const float width = ImGui::GetContentRegionAvail().x;
  const float label_width = std::min(0.42f * width, style.points(170));
  const std::string label = label_of(info);
  ImGui::AlignTextToFramePadding();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 mark{corner.x - style.points(7), corner.y + 0.5f * ImGui::GetFrameHeight()};
  const bool waits = std::ranges::find(not_stored_, parameter) != not_stored_.end();
  if (waits)
    not_stored_mark(mark, style);
  else if (changed)
    ImGui::GetWindowDrawList()->AddCircleFilled(mark, style.points(2.6f), packed(palette.accent));
  text(changed ? palette.text : palette.text_quiet, fitted(label, label_width - style.points(4)));
  help_on_hover(label, help_of(info), style);

  ImGui::SameLine();
  ImGui::SetCursorPosX(left + label_width);
  const float field_width = width - label_width - style.points(unit_points + reset_points);
  if (info.kind == ParameterKind::choice)
    draw_choice(parameter, label, field_width, frame);
  else
    draw_number(parameter, label, field_width, frame);

  ImGui::SameLine(0, style.points(6));
  ImGui::AlignTextToFramePadding();
  text(style.fonts.caption, palette.text_quiet, shown_unit(info.unit).name);
  if (changed) {
    ImGui::SameLine();
    ImGui::SetCursorPosX(left + width - style.points(reset_points - 4));
    if (reset_button(style)) {
      const ParameterChange change{parameter, info.default_value};
      note_edit(parameter);
      editor.apply(label, {&change, 1}, frame.now_s);
    }
    help_on_hover("",
                  fmt::format("Restores the default, {:g} {}", shown_unit(info.unit).factor * info.default_value,
                              shown_unit(info.unit).name),
                  style);
  }
  ImGui::PopID();
}

void TuningPane::draw_group(std::string_view group, const PaneFrame& frame) {
  const Style& style = frame.style;
  ParameterEditor& editor = frame.editor;
  std::string title{group};
  title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  const bool often_used = group == "box" || group == "contact" || group == "current loop" || group == "force law";
  int changed = 0;
  for (std::size_t i = 0; i < protocol::known_parameters().size(); ++i)
    if (protocol::known_parameters()[i].group == group && editor.known() &&
        editor.differs_from_default(static_cast<Parameter>(i)))
      ++changed;
  ImGui::Dummy({0, style.points(1)});
  ImGui::PushFont(style.fonts.strong);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2{style.points(2), style.points(5)});
  ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 0.0f);
  const bool open = ImGui::CollapsingHeader((title + "###" + std::string(group)).c_str(),
                                            often_used ? ImGuiTreeNodeFlags_DefaultOpen : 0);
  note_item(group);
  ImGui::PopStyleVar(2);
  ImGui::PopFont();
  if (changed > 0) {
    ImGui::PushFont(style.fonts.caption);
    ImGui::SameLine();
    right_text(style.palette->accent, fmt::format("{} changed", changed),
               ImGui::GetContentRegionAvail().x - style.points(4));
    ImGui::PopFont();
  }
  if (!open) return;
  ImGui::Indent(style.points(rows_indent_points));
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2{style.points(8), style.points(4.5f)});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{style.points(4), style.points(3)});
  for (std::size_t i = 0; i < protocol::known_parameters().size(); ++i)
    if (protocol::known_parameters()[i].group == group) draw_row(static_cast<Parameter>(i), frame);
  ImGui::PopStyleVar(2);
  ImGui::Unindent(style.points(rows_indent_points));
}

void TuningPane::choose_file(FileTask task) {
  task_ = task;
  const bool saving = task == FileTask::save;
  chooser_.ask({.title = saving ? "Save parameters" : "Load parameters",
                .help = saving ? "A TOML file with value, unit, range and default of every parameter."
                               : "A saved parameter file or an arm description.",
                .button = saving ? "Save" : "Load",
                .endings = {".toml"},
                .is_new_file = saving,
                .suggestion = file_});
}

void TuningPane::draw_file_dialog(const PaneFrame& frame) {
  const auto chosen = chooser_.draw(frame.style);
  if (!chosen) return;
  if (task_ == FileTask::load)
    load(*chosen, frame.editor, frame.now_s);
  else
    save(*chosen, frame.editor);
}

void TuningPane::draw(const PaneFrame& frame) {
  draw_heading(frame);
  ImGui::BeginDisabled(!frame.editor.known());
  draw_presets(frame);
  if (frame.is_replay)
    wrapped_text(frame.style.palette->caution,
                 "These parameters are from the recording. Close the replay to tune the device.");
  draw_question(frame);
  not_stored_ = frame.is_replay ? std::vector<Parameter>{} : not_stored(desk_.view());
  const float store_height = frame.is_replay ? 0.0f : store_bar_.height(ImGui::GetContentRegionAvail().x, frame.style);
  if (ImGui::BeginChild("parameters", {0, -store_height}, false, ImGuiWindowFlags_NavFlattened)) {
    std::string_view group;
    for (const protocol::ParameterInfo& info : protocol::known_parameters()) {
      if (info.group == group) continue;
      group = info.group;
      draw_group(group, frame);
    }
  }
  const float list_bottom = ImGui::GetWindowPos().y + ImGui::GetWindowSize().y;
  ImGui::EndChild();
  draw_messages(frame, list_bottom);
  ImGui::EndDisabled();
  if (!frame.is_replay) store_bar_.draw(frame.editor, frame.style, frame.now_s);
  draw_file_dialog(frame);
}

}  // namespace

std::unique_ptr<Pane> tuning_pane(const PaneSurroundings& around) { return std::make_unique<TuningPane>(around); }

}  // namespace inkwell::window
