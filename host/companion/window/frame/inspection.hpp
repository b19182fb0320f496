// Inspection of the window for tests that simulate a user.
//
// With `--inspect`, the window answers each line on standard input with one line of JSON on standard output. The answer
// describes a frame that was started after the line had arrived. `look` returns the visible named items and texts,
// `picture FILE` writes a PNG file, and `close` closes the window.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <imgui.h>
#include <nlohmann/json_fwd.hpp>

namespace inkwell::window {

// The functions record the last drawn item under a name that includes the pane, such as "status/STOP". Without an
// inspection, the functions do nothing.
void note_item(std::string_view name);
void note_area(std::string_view name, ImVec2 minimum, ImVec2 maximum);
void note_text(std::string_view text);

class Inspection {
 public:
  /// A separate thread reads standard input and calls `wake` after each line, so that the window never waits for input.
  explicit Inspection(void (*wake)());
  ~Inspection();
  Inspection(const Inspection&) = delete;
  Inspection& operator=(const Inspection&) = delete;

  /// True if the next frame must be drawn for the answer to a request.
  bool is_asked();
  /// True if a picture was requested.
  bool wants_picture() const;
  /// Starts recording items and texts. `origin`: screen position of the window. The origin is added to all positions.
  void begin_frame(ImVec2 origin);
  /// Answers the requests that arrived before the frame. The bound framebuffer contains the frame. `more` is added to
  /// the answer to `look`. Returns false if the window must be closed.
  bool end_frame(const nlohmann::json& more, int width, int height);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::window
