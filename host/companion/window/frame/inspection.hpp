// Inspection of the window for tests that simulate a user.
// With `--inspect`, the window answers each line on standard input with one line of JSON on standard output. The answer
// describes a frame that starts after the arrival of the line. `look` returns the visible named items and texts,
// `picture FILE` writes a PNG file, and `close` closes the window.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <imgui.h>
#include <nlohmann/json_fwd.hpp>

namespace inkwell::window {

// These functions record items and texts for an inspection. Item names include the pane, such as "status/STOP".
void note_item(std::string_view name);
void note_area(std::string_view name, ImVec2 minimum, ImVec2 maximum);
void note_text(std::string_view text);

class Inspection {
 public:
  /// A separate thread reads standard input, and calls `wake` after each line.
  explicit Inspection(void (*wake)());
  ~Inspection();
  Inspection(const Inspection&) = delete;
  Inspection& operator=(const Inspection&) = delete;

  /// Collects the requests for the next frame. Returns true if the next frame must answer a request.
  bool collect_requests();
  /// Returns true if a picture was requested.
  bool wants_picture() const;
  /// Starts recording items and texts. Adds `origin`, the screen position of the window, to all positions.
  void begin_frame(ImVec2 origin);
  /// Answers the requests that arrived before the frame. The bound framebuffer must contain the frame. `more` is added
  /// to the answer to `look`. Returns false if the window must be closed.
  bool end_frame(const nlohmann::json& more, int width, int height);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::window
