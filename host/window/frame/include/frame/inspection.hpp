// Inspection of the window for tests that simulate a user: positions of its parts, its texts, and pictures.
//
// With `--inspect`, each line on standard input gets a one-line JSON answer on standard output. The answer follows
// after a complete frame that began after the line had arrived. `look` returns the visible named items and texts of
// that frame, `picture FILE` writes a PNG file, `close` closes the window.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <imgui.h>
#include <nlohmann/json_fwd.hpp>

namespace inkwell::window {

// Record the item that was drawn last, with the name of its pane, such as "status/STOP". Without an inspection they
// cost only a comparison.
void note_item(std::string_view name);
void note_place(std::string_view name, ImVec2 minimum, ImVec2 maximum);
void note_text(std::string_view text);

class Inspection {
 public:
  /// A separate thread reads standard input, so that the window never waits for it. That thread calls `wake` when a
  /// line has arrived.
  explicit Inspection(void (*wake)());
  ~Inspection();
  Inspection(const Inspection&) = delete;
  Inspection& operator=(const Inspection&) = delete;

  /// Whether the next frame must answer a request and therefore must be drawn.
  bool is_asked();
  /// Whether a picture was requested, which justifies a slow frame.
  bool wants_picture() const;
  /// Starts recording names. `origin`: corner of the window on the screen, the origin of the reported positions.
  void begin_frame(ImVec2 origin);
  /// Answers the requests that arrived before the frame began. The frame is in the bound framebuffer. `more` is added
  /// to the answer to `look`. False if the window must be closed.
  bool end_frame(const nlohmann::json& more, int width, int height);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::window
