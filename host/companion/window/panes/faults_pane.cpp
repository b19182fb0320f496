// The pane injects faults into a virtual board and shows the detected faults.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "host/companion/window/frame/imgui_versions.hpp"
#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/widgets.hpp"
#include "host/companion/window/panes/fault_choice.hpp"
#include "host/companion/window/panes/fault_injector.hpp"
#include "host/companion/window/panes/fault_log.hpp"
#include "host/companion/window/panes/pane.hpp"

#include "host/companion/window/panes/fault_form.hpp"

namespace inkwell::window {
namespace {

using protocol::InjectedFault;
using InjectionPhase = LoggedInjection::Phase;

constexpr const char* heading = "Fault injection";
constexpr float log_part_maximum = 0.42f;  // of the pane's height
constexpr float low_points = 440.0f;       // a lower pane scrolls as a whole

// Draws a word in a small font inside a frame.
void draw_badge(std::string_view word, const Style& style) {
  ImGui::PushFont(style.fonts.caption);
  const ImVec2 size = ImGui::CalcTextSize(word.data(), word.data() + word.size());
  const float padding = style.points(6);
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - size.x - padding);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  text(style.palette->caution, word);
  ImGui::GetWindowDrawList()->AddRect({corner.x - padding, corner.y - style.points(1.5f)},
                                      {corner.x + size.x + padding, corner.y + size.y + style.points(1.5f)},
                                      packed(style.palette->caution), style.points(4), 0, style.points(1));
  ImGui::PopFont();
}

std::string when_text(const LoggedInjection& logged) {
  switch (logged.phase) {
    case InjectionPhase::to_come: return fmt::format("starts at {:.2f} s", logged.injection.at_s);
    case InjectionPhase::in: return fmt::format("active since {:.2f} s", logged.injection.at_s);
    case InjectionPhase::over: break;
  }
  return fmt::format("started at {:.2f} s, over", logged.injection.at_s);
}

class FaultsPane final : public Pane {
 public:
  explicit FaultsPane(const PaneSurroundings& around) : desk_(around.desk) {
    if (around.control) board_.emplace(*around.control);
  }

  std::string_view title() const override { return "Faults"; }
  bool take_keyboard() override {
    search_takes_keyboard_ = true;
    return true;
  }
  void follow(const PaneNews& news) override;
  void draw(const PaneFrame& frame) override;
  bool is_moving() const override { return board_ && (board_->has_changed() || log_.waits_for_answer()); }

 private:
  void take(const FaultInjector::News& news);
  void inject();
  void heal_all();
  void draw_heading(const Style& style);
  void draw_log(const Style& style);
  void draw_logged(const LoggedInjection& logged, const Style& style);
  void draw_noticed(const LoggedInjection& logged, const Style& style);
  void draw_search(const Style& style);
  void draw_table(const Style& style);
  /// Returns true if the rows below the title are visible.
  bool draw_title(protocol::InjectionPart part, const Style& style);
  void draw_row(InjectedFault fault, const Style& style);
  void choose(InjectedFault fault);
  void choose_neighbour(int rows);
  std::vector<InjectedFault> found() const;

  DeviceDesk& desk_;
  std::optional<FaultInjector> board_;
  FaultLog log_;
  std::optional<device::NoticedFault> noticed_;
  std::string refusal_;
  std::string gone_;
  std::string search_;
  std::optional<FaultForm> chosen_;
  bool search_takes_keyboard_ = false, chosen_is_to_be_seen_ = false;
  bool is_low_ = false;
  float log_height_ = 0.0f;  ///< total height in the previous frame
};

void FaultsPane::take(const FaultInjector::News& news) {
  if (const auto* gone = std::get_if<FaultInjector::Gone>(&news)) {
    gone_ = gone->sentence;
    return;
  }
  gone_.clear();
  if (const auto* answer = std::get_if<device::Injections>(&news)) log_.take(*answer);
  if (const auto* injection = std::get_if<device::Injection>(&news)) log_.add(*injection);
  if (const auto* refusal = std::get_if<FaultInjector::Refusal>(&news))
    refusal_ = with_readable_name(refusal->sentence);
}

void FaultsPane::follow(const PaneNews&) {
  if (!board_) return;
  for (const FaultInjector::News& each : board_->take_news()) take(each);
  const auto& fault = desk_.view().status.fault;
  if (fault && fault != noticed_) log_.notice(*fault);
  noticed_ = fault;
}

void FaultsPane::inject() {
  refusal_.clear();
  try {
    board_->inject(request_of(chosen_->typed()));
  } catch (const device::Error& error) {
    refusal_ = error.what();
  }
}

void FaultsPane::heal_all() {
  refusal_.clear();
  board_->heal_all();
}

void FaultsPane::draw(const PaneFrame& frame) {
  const Style& style = frame.style;
  if (const auto why = obstacle(desk_.view().status, board_.has_value()); !why.empty()) {
    text(style.fonts.strong, style.palette->text, heading);
    wrapped_text(style.palette->text_quiet, why);
    return;
  }
  const ImGuiIO& io = ImGui::GetIO();
  if (io.KeyCtrl && ImGui::IsKeyPressed(key_index(ImGuiKey_Delete), false) && !is_dialog_open()) heal_all();
  draw_heading(style);
  ImGui::BeginDisabled(!gone_.empty());
  is_low_ = ImGui::GetContentRegionAvail().y < style.points(low_points);
  if (is_low_) {
    ImGui::Separator();  // scrolled rows end at this line
    ImGui::BeginChild("all", {0, 0}, false, ImGuiWindowFlags_NavFlattened);
  }
  draw_log(style);
  draw_search(style);
  draw_table(style);
  if (is_low_) ImGui::EndChild();
  ImGui::EndDisabled();
}

void FaultsPane::draw_heading(const Style& style) {
  text(style.fonts.strong, style.palette->text, heading);
  ImGui::SameLine();
  draw_badge("SIMULATION", style);
  if (!gone_.empty())
    wrapped_text(style.palette->danger_text, fmt::format("The virtual board does not answer. {}", gone_));
  else if (log_.faults().empty())
    wrapped_text(
        style.palette->text_quiet,
        "Inject a fault into the virtual board, and observe the reaction of the firmware. No real arm is affected.");
  if (gone_.empty() && !refusal_.empty()) wrapped_text(style.palette->danger_text, refusal_);
}

void FaultsPane::draw_log(const Style& style) {
  if (log_.faults().empty()) return;
  if (!is_low_)
    ImGui::BeginChild("log", {0, std::min(log_height_, log_part_maximum * ImGui::GetWindowHeight())}, false,
                      ImGuiWindowFlags_NavFlattened);
  for (const LoggedInjection& each : log_.faults()) draw_logged(each, style);
  if (!is_low_) {
    log_height_ = ImGui::GetCursorPosY();
    ImGui::EndChild();
  }
  const bool any =
      std::ranges::any_of(log_.faults(), [](const auto& each) { return each.phase != InjectionPhase::over; });
  ImGui::BeginDisabled(!any);
  if (button("Heal all", {-1, 0})) heal_all();
  help_on_hover("Heal all", "Heals all active faults and cancels all faults that have not started. Key: Ctrl+Delete",
                style);
  ImGui::EndDisabled();
  ImGui::Dummy({0, style.points(4)});
}

void FaultsPane::draw_logged(const LoggedInjection& logged, const Style& style) {
  const Palette& palette = *style.palette;
  const bool is_over = logged.phase == InjectionPhase::over;
  ImGui::PushID(static_cast<int>(logged.injection.number));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ImGui::GetStyle().ItemSpacing.x, style.points(2)});
  ImGui::AlignTextToFramePadding();
  text(style.fonts.strong, is_over ? palette.text_quiet : palette.text, readable_name(logged.injection.fault));
  help_on_hover(logged.injection.fault, "Name in commands and files.", style);
  if (!is_over) {
    const float width = style.points(52);
    ImGui::SameLine();
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - width);
    if (ImGui::Button("Heal", {width, 0})) {
      refusal_.clear();
      board_->heal(logged.injection.fault, logged.injection.of);
    }
    note_item(fmt::format("Heal {}", logged.injection.fault));
  }
  ImGui::PushFont(style.fonts.caption);
  const std::string where = location_and_amount(logged.injection);
  wrapped_text(palette.text_quiet, fmt::format("{}{}{}", where, where.empty() ? "" : ", ", when_text(logged)));
  draw_noticed(logged, style);
  ImGui::PopFont();
  ImGui::PopStyleVar();
  ImGui::Dummy({0, style.points(1)});
  ImGui::PopID();
}

void FaultsPane::draw_noticed(const LoggedInjection& logged, const Style& style) {
  const Palette& palette = *style.palette;
  if (logged.noticed) {
    const auto& [noticed, after_s] = *logged.noticed;
    const auto when = after_s ? fmt::format(", after {}", duration_text(*after_s)) : std::string();
    wrapped_text(palette.caution,
                 fmt::format("Reported fault: {}{}", readable_name(protocol::info(noticed).name), when));
  } else if (logged.phase != InjectionPhase::to_come && !log_.waits_for_answer()) {
    const bool in_fault = desk_.view().state() == protocol::State::fault;
    wrapped_text(palette.text_quiet,
                 in_fault ? "No fault reported: the board was already in a fault" : "No fault reported");
  }
}

std::vector<InjectedFault> FaultsPane::found() const {
  std::vector<InjectedFault> found;
  for (std::size_t i = 0; i < protocol::injection_table.size(); ++i)
    if (is_found(protocol::injection_table[i], search_)) found.push_back(static_cast<InjectedFault>(i));
  return found;
}

void FaultsPane::choose(InjectedFault fault) {
  refusal_.clear();
  const bool same_kind = chosen_ && info(chosen_->typed().fault).location == info(fault).location;
  chosen_.emplace(fault, same_kind ? chosen_->typed().of : std::string());
}

void FaultsPane::choose_neighbour(int rows) {
  const auto all = found();
  if (all.empty()) return;
  const auto now = chosen_ ? std::ranges::find(all, chosen_->typed().fault) : all.end();
  const std::ptrdiff_t index = now == all.end() ? (rows > 0 ? 0 : std::ssize(all) - 1) : now - all.begin() + rows;
  choose(all[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(index, 0, std::ssize(all) - 1))]);
  chosen_is_to_be_seen_ = true;
}

void FaultsPane::draw_search(const Style& style) {
  ImGui::SetNextItemWidth(-1);
  if (std::exchange(search_takes_keyboard_, false)) ImGui::SetKeyboardFocusHere();
  const bool entered =
      ImGui::InputTextWithHint("##search", fmt::format("Search {} faults", protocol::injection_table.size()).c_str(),
                               &search_, ImGuiInputTextFlags_EnterReturnsTrue);
  note_item("search");
  help_on_hover(
      "Search",
      "Searches names, parts and help texts. Up and Down select a fault. Enter moves to the fields of the fault.",
      style);
  keep_vertical_arrows();
  if (ImGui::IsItemActive()) {
    if (ImGui::IsKeyPressed(key_index(ImGuiKey_DownArrow))) choose_neighbour(1);
    if (ImGui::IsKeyPressed(key_index(ImGuiKey_UpArrow))) choose_neighbour(-1);
  }
  if (!entered) return;
  const auto all = found();
  if (!chosen_ || std::ranges::find(all, chosen_->typed().fault) == all.end()) choose_neighbour(1);
  if (chosen_) chosen_->take_keyboard();
}

void FaultsPane::draw_table(const Style& style) {
  if (!is_low_) ImGui::BeginChild("table", {0, 0}, false, ImGuiWindowFlags_NavFlattened);
  const auto all = found();
  if (all.empty()) wrapped_text(style.palette->text_quiet, "No fault matches the search.");
  std::optional<protocol::InjectionPart> part;
  bool is_open = false;
  for (const InjectedFault fault : all) {
    if (part != info(fault).part) {
      part = info(fault).part;
      is_open = draw_title(*part, style);
    }
    if (is_open) draw_row(fault, style);
  }
  if (!is_low_) ImGui::EndChild();
}

bool FaultsPane::draw_title(protocol::InjectionPart part, const Style& style) {
  const bool holds_wanted = chosen_ && chosen_is_to_be_seen_ && info(chosen_->typed().fault).part == part;
  if (!search_.empty() || holds_wanted) ImGui::SetNextItemOpen(true);
  ImGui::PushFont(style.fonts.strong);
  ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 0.0f);
  const bool is_open = ImGui::CollapsingHeader(std::string(title_of(part)).c_str());
  ImGui::PopStyleVar();
  note_item(title_of(part));
  ImGui::PopFont();
  return is_open;
}

void FaultsPane::draw_row(InjectedFault fault, const Style& style) {
  const std::string name(info(fault).name);
  const bool is_chosen = chosen_ && chosen_->typed().fault == fault;
  ImGui::Indent(style.points(12));
  if (is_chosen) ImGui::PushStyleColor(ImGuiCol_Text, packed(style.palette->accent));
  if (ImGui::Selectable(fmt::format("{}###{}", readable_name(name), name).c_str(), is_chosen)) {
    if (is_chosen) {
      chosen_.reset();
    } else {
      choose(fault);
      chosen_is_to_be_seen_ = is_low_;
    }
  }
  note_item(name);
  if (is_chosen) ImGui::PopStyleColor();
  if (!is_chosen) help_on_hover(name, protocol::help_of(info(fault)), style);
  if (is_chosen && std::exchange(chosen_is_to_be_seen_, false)) ImGui::SetScrollHereY(0.0f);
  if (chosen_ && chosen_->typed().fault == fault && chosen_->draw(style)) inject();
  ImGui::Unindent(style.points(12));
}

}  // namespace

std::unique_ptr<Pane> faults_pane(const PaneSurroundings& around) { return std::make_unique<FaultsPane>(around); }

}  // namespace inkwell::window
