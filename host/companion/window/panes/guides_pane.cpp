// The pane runs a guide, and shows the current step, the measured values and the results.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "host/client/device/parameter_file.hpp"
#include "host/client/guides/guides.hpp"
#include "host/client/guides/session_port.hpp"
#include "host/client/guides/simulated_user.hpp"
#include "host/companion/window/device_desk/stored_values.hpp"
#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/keyboard.hpp"
#include "host/companion/window/frame/value_field.hpp"
#include "host/companion/window/frame/widgets.hpp"
#include "host/companion/window/panes/pane.hpp"
#include "host/companion/window/plot/plot.hpp"
#include "host/companion/window/plot/plot_saver.hpp"

#include "host/companion/window/panes/store_bar.hpp"

namespace inkwell::window {
namespace {

using guides::Phase;

Colour outcome_colour(Phase phase, const Palette& palette) {
  switch (phase) {
    case Phase::finished: return palette.good;
    case Phase::failed: return palette.danger_text;
    default: return palette.caution;
  }
}

constexpr const char* step_response = "Step response";

/// Returns the displayed part of the curves.
PlotTable guides_table(const std::vector<guides::Curve>& curves, const PlotArea& area) {
  std::vector<NamedPoints> lines;
  for (const guides::Curve& curve : curves) lines.push_back({curve.name + " A", curve.points});
  PlotTable table = table_of(lines, area.x);
  table.title = step_response;
  table.x_name = "time_ms";
  table.y_range = area.y;
  return table;
}

class GuidesPane final : public Pane {
 public:
  explicit GuidesPane(const PaneSurroundings& around)
      : desk_(around.desk), control_(around.control), simulated_arm_(around.simulated_arm) {}
  /// Cancels a running guide, switches the force off and restores trial parameters.
  ~GuidesPane() override { GuidesPane::cancel(); }

  std::string_view title() const override { return "Guides"; }
  void follow(const PaneNews& news) override;
  void draw(const PaneFrame& frame) override;
  /// Stops a running guide and switches the motors off.
  void cancel() override;
  /// Reserves the scope stream while the guide needs signals.
  PaneStream stream() const override { return {signals_, false}; }
  bool is_moving() const override { return is_running() || saver_.is_saving(); }
  PlotSaver* plot_saver() override { return &saver_; }
  void start_guide(std::string_view name) override;
  std::string why_force_waits() const override {
    return is_running() ? "A guide runs and decides about the currents. Finish or cancel the guide first." : "";
  }

 private:
  void start(guides::Guide guide);
  guides::Choices choices() const;
  bool is_running() const { return guide_ && !guide_->is_over(); }
  void draw_offers(const Style& style);
  void draw_bandwidth(const Style& style);
  void draw_step(const Style& style);
  void draw_checks(const Style& style);
  void draw_result(const Style& style);
  void draw_what_lasts(const Style& style) const;
  /// Draws one line per proposal. The tooltip shows the reason for the proposal.
  void draw_proposals(const Style& style);
  void draw_curves(const Style& style);
  void draw_buttons(const Style& style);
  guides::SessionPort port();
  void run_simulated_user();

  DeviceDesk& desk_;
  std::optional<device::SocketAddress> control_;
  std::optional<protocol::ParameterSet> simulated_arm_;
  bool hand_helps_ = true;
  ValueFields fields_;
  float bandwidth_Hz_ = static_cast<float>(guides::bandwidth_default_Hz);
  std::optional<guides::Guide> guide_;
  guides::Applied shown_applied_{};  ///< in the previous frame
  std::optional<guides::SimulatedUser> user_;
  std::string user_problem_;
  std::vector<protocol::Signal> signals_;
  PlotSaver saver_;
};

guides::SessionPort GuidesPane::port() {
  return {desk_.session(), [this](std::vector<protocol::Signal> wanted) { signals_ = std::move(wanted); }};
}

void GuidesPane::start(guides::Guide guide) {
  guide_.emplace(std::move(guide));
  user_.reset();
  user_problem_.clear();
  signals_.clear();
  if (!control_ || !hand_helps_) return;
  try {
    const auto& held = desk_.view().parameters;
    user_.emplace(device::ControlClient(*control_),
                  simulated_arm_ ? *simulated_arm_ : held.value_or(protocol::default_parameters()));
  } catch (const device::Error& error) {
    user_problem_ = error.what();
  }
}

void GuidesPane::start_guide(std::string_view name) {
  if (is_running()) return;
  for (const guides::Offer* offer : guides::all_guides())
    if (offer->name == name) start(offer->start(choices()));
}

guides::Choices GuidesPane::choices() const {
  guides::Choices choices;
  choices.current_loop.bandwidth_Hz = static_cast<double>(bandwidth_Hz_);
  return choices;
}

void GuidesPane::run_simulated_user() {
  if (!user_ || !guide_ || guide_->phase() != Phase::working) return;
  try {
    user_->advance(guide_->step().user_task());
  } catch (const device::Error& error) {
    user_problem_ = error.what();
    user_.reset();
  }
}

void GuidesPane::follow(const PaneNews& news) {
  if (!guide_) return;
  for (const auto& samples : news.samples) guide_->receive(samples);
  auto to_device = port();
  guide_->advance(guides::observe(desk_.session()), to_device);
  run_simulated_user();
}

void GuidesPane::cancel() {
  if (!is_running()) return;
  auto to_device = port();
  guide_->cancel(to_device);
}

void GuidesPane::draw(const PaneFrame& frame) {
  const Style& style = frame.style;
  if (!guide_) {
    if (ImGui::BeginChild("offers", {0, 0}, false, ImGuiWindowFlags_NavFlattened)) draw_offers(style);
    ImGui::EndChild();
  } else {
    text(style.fonts.strong, style.palette->text, guide_->title());
    const float room = ImGui::GetFrameHeightWithSpacing() + style.points(6);
    if (ImGui::BeginChild("guide", {0, -room}, false, ImGuiWindowFlags_NavFlattened)) {
      if (const auto applied = guide_->applied(); std::exchange(shown_applied_, applied) != applied)
        ImGui::SetScrollY(0.0f);  // the result is shown at the top
      scroll_by_page_keys();
      if (guide_->is_over()) {
        draw_result(style);
      } else {
        draw_step(style);
        draw_curves(style);
      }
    }
    ImGui::EndChild();
    saver_.draw("guide message", ImGui::GetCursorScreenPos().y, style);
    draw_buttons(style);
  }
}

void GuidesPane::draw_offers(const Style& style) {
  const bool connected = desk_.view().connected();
  wrapped_text(
      style.palette->text_quiet,
      connected
          ? "Each guide describes its actions before the arm moves. Press Apply to accept the proposals of a guide."
          : "Guides need a device. Plug in a device.");
  ImGui::Dummy({0, style.points(4)});
  ImGui::BeginDisabled(!connected);
  for (const guides::Offer* offer : guides::all_guides()) {
    if (button(std::string(offer->title).c_str(), {ImGui::GetContentRegionAvail().x, style.points(30)})) {
      start(offer->start(choices()));
    }
    wrapped_text(style.palette->text_quiet, offer->help);
    ImGui::Dummy({0, style.points(4)});
  }
  ImGui::EndDisabled();
  draw_bandwidth(style);
  if (!control_) return;
  ImGui::Dummy({0, style.points(4)});
  ImGui::Checkbox("Simulated hand performs the steps", &hand_helps_);
  note_item("hand helps");
}

void GuidesPane::draw_bandwidth(const Style& style) {
  static constexpr ValueRange range{.minimum = static_cast<float>(guides::bandwidth_minimum_Hz),
                                    .maximum = static_cast<float>(guides::bandwidth_maximum_Hz),
                                    .decimals = 0};
  text(style.palette->text_quiet, "Current-loop bandwidth / Hz");
  const ValueEdit edit =
      fields_.draw("##bandwidth", "bandwidth", bandwidth_Hz_, range, ImGui::GetContentRegionAvail().x, style);
  if (edit.dragged_to) bandwidth_Hz_ = *edit.dragged_to;
  if (!edit.typed) return;
  if (const auto typed_Hz = device::parse_number(*edit.typed); typed_Hz && range.contains(*typed_Hz))
    bandwidth_Hz_ = *typed_Hz;
}

void GuidesPane::draw_step(const Style& style) {
  const Palette& palette = *style.palette;
  const auto& step = guide_->step();
  text(style.fonts.caption, palette.text_quiet,
       fmt::format("Step {} of {}", guide_->step_index() + 1, guide_->step_count()));
  ImGui::PushStyleColor(ImGuiCol_PlotHistogram, packed(palette.accent));
  ImGui::ProgressBar(static_cast<float>(guide_->progress()), {-1, style.points(6)}, "");
  ImGui::PopStyleColor();
  ImGui::Dummy({0, style.points(2)});
  text(style.fonts.strong, palette.text, step.title());
  wrapped_text(palette.text, step.text());
  if (guide_->phase() == Phase::awaits_consent)
    wrapped_text(palette.caution, "The guide waits until you press Confirm.");
  if (!user_problem_.empty()) wrapped_text(palette.danger_text, user_problem_);
  ImGui::Dummy({0, style.points(4)});
  if (guide_->phase() == Phase::working) draw_checks(style);
}

void GuidesPane::draw_checks(const Style& style) {
  const Palette& palette = *style.palette;
  for (const auto& check : guide_->step().checks()) {
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + 0.58f * width);
    text(palette.text_quiet, check.name);
    ImGui::PopTextWrapPos();
    ImGui::SameLine(0, 0);
    ImGui::SetCursorPosX(0.58f * width);
    right_text(check.expected.empty() || check.passed ? palette.text : palette.caution, guides::measured_text(check),
               0.42f * width);
    if (check.expected.empty()) continue;
    text(style.fonts.caption, check.passed ? palette.good : palette.text_quiet,
         fmt::format("{}: {}", check.passed ? "as expected" : "expected", check.expected));
  }
}

void GuidesPane::draw_result(const Style& style) {
  const Palette& palette = *style.palette;
  const bool applied = guide_->applied() == guides::Applied::yes;
  wrapped_text(outcome_colour(guide_->phase(), palette),
               applied ? "Finished. The device uses the proposed values." : guide_->outcome());
  if (applied) draw_what_lasts(style);
  if (!guide_->refusal().empty()) wrapped_text(palette.danger_text, guide_->refusal());
  if (guide_->phase() == Phase::finished && !guide_->findings().proposals.empty()) draw_proposals(style);
  draw_curves(style);
  ImGui::Dummy({0, style.points(4)});
  for (const auto& sentence : guide_->findings().sentences) wrapped_text(palette.text, sentence);
}

void GuidesPane::draw_proposals(const Style& style) {
  const Palette& palette = *style.palette;
  const float width = ImGui::GetContentRegionAvail().x, left = ImGui::GetCursorPosX();
  const auto columns = [&](Colour colour, const std::string& name, const std::string& proposed,
                           const std::string& held) {
    text(palette.text_quiet, fitted(name, 0.5f * width));
    ImGui::SameLine(0, 0);
    ImGui::SetCursorPosX(left + 0.5f * width);
    right_text(colour, proposed, 0.25f * width);
    ImGui::SameLine(0, 0);
    ImGui::SetCursorPosX(left + 0.75f * width);
    right_text(palette.text_quiet, held, 0.24f * width);
  };
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{style.points(4), style.points(2)});
  columns(palette.text, "", guide_->applied() == guides::Applied::yes ? "Applied" : "Proposed", "Before");
  for (const auto& proposal : guide_->findings().proposals) {
    ImGui::BeginGroup();
    columns(palette.text, label_of(info(proposal.parameter)),
            device::format_value(proposal.parameter, proposal.proposed),
            device::format_value(proposal.parameter, proposal.held));
    ImGui::EndGroup();
    help_on_hover(info(proposal.parameter).name, proposal.reason, style);
  }
  ImGui::PopStyleVar();
}

/// Shows whether the applied parameters are stored.
void GuidesPane::draw_what_lasts(const Style& style) const {
  const Palette& palette = *style.palette;
  const DeviceView& view = desk_.view();
  if (view.status.store_problem)
    wrapped_text(palette.caution, *view.status.store_problem);
  else if (not_stored(view).empty())
    wrapped_text(palette.text_quiet, "The values are stored on the board.");
  else
    wrapped_text(palette.caution, "The values are lost at power-off unless you store them.");
}

void GuidesPane::draw_curves(const Style& style) {
  const auto& curves = guide_->findings().curves;
  if (curves.empty()) return;
  const Palette& palette = *style.palette;
  double most_A = 0.1, least_A = 0, last_ms = 1;
  for (const auto& curve : curves)
    for (const auto& [time_ms, current_A] : curve.points) {
      most_A = std::max(most_A, current_A);
      least_A = std::min(least_A, current_A);
      last_ms = std::max(last_ms, time_ms);
    }
  ImGui::Dummy({0, style.points(6)});
  ImGui::AlignTextToFramePadding();
  text(style.fonts.strong, palette.text, step_response);
  const float save_width = style.points(64);
  ImGui::SameLine(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - save_width);
  if (button("Save##plot", {save_width, 0})) ImGui::OpenPopup("plot menu");
  help_on_hover("", "Saves the plot as a picture, a drawing or values.", style);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float row_height = style.fonts.caption->FontSize + ImGui::GetStyle().ItemSpacing.y,
              names_height = static_cast<float>((curves.size() + 1) / 2) * row_height + style.points(6);
  const float width = ImGui::GetContentRegionAvail().x,
              height = std::clamp(ImGui::GetContentRegionAvail().y - names_height, style.points(90), style.points(260));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const PlotArea area{{corner.x + style.points(38), corner.y},
                      {corner.x + width - style.points(4), corner.y + height - style.points(20)},
                      {-0.2, std::min(last_ms, 2.0)},
                      enclosing_range(least_A, most_A)};
  draw_axes(list, area, style, "ms", "A");
  for (std::size_t i = 0; i < curves.size(); ++i)
    draw_points(list, area, curves[i].points, palette.lines[i % palette.lines.size()], style);
  ImGui::Dummy({width, height});
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (i % 2 == 1) ImGui::SameLine(0.5f * width);
    text(style.fonts.caption, palette.lines[i % palette.lines.size()], curves[i].name);
  }
  saver_.set_areas({{corner.x, corner.y, corner.x + width, ImGui::GetCursorScreenPos().y}});
  if (!ImGui::BeginPopup("plot menu")) return;
  if (const auto format = choose_plot_format())
    saver_.ask(*format, 0, step_response, [&] { return guides_table(curves, area); });
  ImGui::EndPopup();
}

void GuidesPane::draw_buttons(const Style& style) {
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 half{0.5f * (ImGui::GetContentRegionAvail().x - gap), 0};
  if (!guide_->is_over()) {
    ImGui::BeginDisabled(!guide_->takes_confirmation());
    if (primary_button("Confirm", style, half)) guide_->confirm();
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (button("Cancel", half)) cancel();
    return;
  }
  if (guide_->applied() == guides::Applied::yes) {
    store_button(desk_, half, style);
    ImGui::SameLine();
    if (button("Back", half)) guide_.reset();
    return;
  }
  const bool applicable = guide_->phase() == Phase::finished && !guide_->findings().proposals.empty() &&
                          (guide_->applied() == guides::Applied::no || guide_->applied() == guides::Applied::refused);
  ImGui::BeginDisabled(!applicable || !desk_.view().connected());
  if (primary_button("Apply", style, half)) {
    auto to_device = port();
    guide_->apply(to_device);
  }
  ImGui::EndDisabled();
  ImGui::SameLine();
  if (button("Back", half)) guide_.reset();
}

}  // namespace

std::unique_ptr<Pane> guides_pane(const PaneSurroundings& around) { return std::make_unique<GuidesPane>(around); }

}  // namespace inkwell::window
