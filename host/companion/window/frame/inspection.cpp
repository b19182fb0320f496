#include "host/companion/window/frame/inspection.hpp"

#include <algorithm>
#include <array>
#include <mutex>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <imgui_internal.h>
#include <poll.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "host/client/local/interruption.hpp"

#include "host/companion/window/frame/display.hpp"

namespace inkwell::window {

namespace {

constexpr int stop_is_seen_within_ms = 100;
constexpr std::string_view picture = "picture ";

struct Notes {
  nlohmann::json items = nlohmann::json::object();
  nlohmann::json texts = nlohmann::json::array();
  ImVec2 origin{0, 0};
};

Notes* notes = nullptr;  // for the current frame; null without a request

// Returns the visible part of an ImGui label, or the identifier of an invisible label.
std::string_view name_in(std::string_view label) {
  return label.starts_with("##") ? label.substr(2) : label.substr(0, label.find("##"));
}

void note(std::string_view name, const ImRect& area, bool active, bool has_keyboard) {
  const ImGuiWindow& pane = *ImGui::GetCurrentWindow()->RootWindow;
  const bool enabled = (GImGui->CurrentItemFlags & ImGuiItemFlags_Disabled) == 0;
  notes->items[fmt::format("{}/{}", pane.Name, name_in(name))] = {{"x", area.Min.x + notes->origin.x},
                                                                  {"y", area.Min.y + notes->origin.y},
                                                                  {"width", area.GetWidth()},
                                                                  {"height", area.GetHeight()},
                                                                  {"enabled", enabled},
                                                                  {"active", active},
                                                                  {"keyboard", has_keyboard}};
}

}  // namespace

void note_item(std::string_view name) {
  if (notes == nullptr) return;
  ImRect seen = GImGui->LastItemData.Rect;
  seen.ClipWith(ImGui::GetCurrentWindow()->ClipRect);
  if (seen.GetWidth() <= 1.0f || seen.GetHeight() <= 1.0f) return;
  const bool has_keyboard = GImGui->NavId == GImGui->LastItemData.ID && !GImGui->NavDisableHighlight;
  note(name, seen, ImGui::IsItemActive(), has_keyboard);
}

void note_area(std::string_view name, ImVec2 minimum, ImVec2 maximum) {
  if (notes != nullptr) note(name, {minimum, maximum}, false, false);
}

void note_text(std::string_view text) {
  if (notes != nullptr) notes->texts.push_back(text);
}

struct Inspection::Implementation {
  explicit Implementation(void (*wake)()) : reader([this, wake](const std::stop_token& stop) { read(stop, wake); }) {}

  void read(const std::stop_token& stop, void (*wake)()) {
    std::string received;
    while (!stop.stop_requested()) {
      pollfd input{STDIN_FILENO, POLLIN, 0};
      if (poll(&input, 1, stop_is_seen_within_ms) <= 0) continue;
      std::array<char, 256> chunk;
      const ssize_t length =
          local::repeat_interrupted([&] { return ::read(STDIN_FILENO, chunk.data(), chunk.size()); });
      if (length <= 0) return;
      received.append(chunk.data(), static_cast<std::size_t>(length));
      for (std::size_t end; (end = received.find('\n')) != std::string::npos; received.erase(0, end + 1)) {
        const std::scoped_lock lock(mutex);
        asked.push_back(received.substr(0, end));
      }
      wake();
    }
  }

  std::mutex mutex;
  std::vector<std::string> asked;
  std::vector<std::string> due;  ///< requests to answer at the end of the frame
  Notes noted;
  std::jthread reader;  ///< last: the thread uses all other members
};

Inspection::Inspection(void (*wake)()) : implementation_(std::make_unique<Implementation>(wake)) {}
Inspection::~Inspection() { notes = nullptr; }

bool Inspection::collect_requests() {
  auto& self = *implementation_;
  const std::scoped_lock lock(self.mutex);
  self.due.insert(self.due.end(), self.asked.begin(), self.asked.end());
  self.asked.clear();
  return !self.due.empty();
}

bool Inspection::wants_picture() const {
  return std::ranges::any_of(implementation_->due, [](const std::string& line) { return line.starts_with(picture); });
}

void Inspection::begin_frame(ImVec2 origin) {
  auto& self = *implementation_;
  self.noted = {};
  self.noted.origin = origin;
  notes = self.due.empty() ? nullptr : &self.noted;
}

bool Inspection::end_frame(const nlohmann::json& more, int width, int height) {
  auto& self = *implementation_;
  notes = nullptr;
  bool goes_on = true;
  for (const std::string& line : self.due) {
    nlohmann::json answer;
    if (line == "look") {
      answer = more;
      answer["items"] = self.noted.items;
      answer["texts"] = self.noted.texts;
    } else if (line.starts_with(picture)) {
      const std::string file = line.substr(picture.size());
      write_screenshot(file, width, height);
      answer["written"] = file;
    } else if (line == "close") {
      answer["closing"] = true;
      goes_on = false;
    } else {
      answer["error"] = "Unknown request. Send look, picture FILE or close.";
    }
    fmt::print("{}\n", answer.dump());
  }
  if (!self.due.empty()) std::fflush(stdout);
  self.due.clear();
  return goes_on;
}

}  // namespace inkwell::window
