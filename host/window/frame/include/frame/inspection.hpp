// What a test that plays the user asks of the window: where its parts are, what is written in it, a picture.
//
// With `--inspect`, each line on standard input is answered by one line of JSON on standard output, after a
// whole frame that began when the line had come. `look` tells the named items that can be seen and the texts
// of that frame, `picture FILE` writes it to a PNG, `close` closes the window.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <imgui.h>
#include <nlohmann/json_fwd.hpp>

namespace inkwell::window {

// These name what was drawn last, preceded by its pane, such as "status/STOP". They cost a comparison while
// nobody inspects.
void note_item(std::string_view name);
void note_place(std::string_view name, ImVec2 minimum, ImVec2 maximum);
void note_text(std::string_view text);

class Inspection {
 public:
  /// Reads standard input in a thread of its own, so that the window never waits for it. `wake` is called from
  /// that thread when a line has come.
  explicit Inspection(void (*wake)());
  ~Inspection();
  Inspection(const Inspection&) = delete;
  Inspection& operator=(const Inspection&) = delete;

  /// Whether the next frame has something to answer, so that it has to be drawn.
  bool is_asked();
  /// Whether a picture is among it, which is worth more than a quick frame.
  bool wants_picture() const;
  /// Names are noted from here on. `origin`: the window's corner on the screen, from which places are counted.
  void begin_frame(ImVec2 origin);
  /// Answers what was asked before the frame began; its picture is in the bound framebuffer. `more` is added to
  /// what `look` tells. False if the window is to be closed.
  bool end_frame(const nlohmann::json& more, int width, int height);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::window
