// The pane with the arm, the sphere and the walls, and what the mouse does in it.
#pragma once

#include <memory>
#include <optional>

#include <device_desk/parameter_editor.hpp>
#include <frame/picture_digest.hpp>
#include <frame/style.hpp>
#include <scene/camera.hpp>
#include <scene/mouse_hand.hpp>
#include <scene/scene_look.hpp>
#include <scene/scene_model.hpp>
#include <scene/scene_solids.hpp>

namespace inkwell::window {

struct ScenePaneInput {
  const Style& style;
  const std::optional<device::Pose>& pose;
  ParameterEditor& editor;
  MouseHand* hand;  ///< null without a virtual board
  double now_s;
  bool is_replay = false;    ///< pose and parameters are a recording's
  bool offers_force = true;  ///< nothing else has to be settled first
};

class Renderer;

class ScenePane {
 public:
  /// OpenGL is ready to draw.
  ScenePane();
  ~ScenePane();

  /// Handles the mouse and draws the labels; the picture below them comes from draw_scene. True if the user asks for
  /// the force.
  bool draw(ImVec2 place, ImVec2 size, const ScenePaneInput& input);
  void draw_scene(const Viewport& viewport, SceneLook look) const;
  /// What of the picture depends on the mouse and the hand.
  void add_to(PictureDigest& digest) const;
  void reset_view() { view_is_to_be_reset_ = true; }

 private:
  enum class Drag : std::uint8_t { none, orbit, pan, hand, wall };

  void handle_mouse(const ScenePaneInput& input);
  /// Shift with the arrows turns, with Ctrl too it moves the picture; Ctrl with the arrows moves the simulated hand.
  void handle_keys(const ScenePaneInput& input);
  void start_drag(const ScenePaneInput& input, glm::vec2 mouse);
  void continue_drag(const ScenePaneInput& input, glm::vec2 mouse, glm::vec2 moved);
  void end_drag(const ScenePaneInput& input);
  std::optional<int> wall_under(glm::vec2 mouse, float reach) const;
  glm::vec3 wall_handle(int wall) const;

  void note_handles() const;
  void draw_proxy_label(ImDrawList& list, const Style& style) const;
  void draw_labels(const ScenePaneInput& input) const;
  void draw_axes(ImDrawList& list, const Style& style) const;
  void draw_tools(const ScenePaneInput& input);
  /// Why nothing pushes back, and the button for it; true if that is pressed.
  bool draw_force_offer(const ScenePaneInput& input) const;
  void draw_replay_frame(const Style& style) const;
  ImVec2 on_screen(glm::vec3 workspace_point_m) const;

  std::unique_ptr<Renderer> renderer_;
  SceneModel scene_{};
  std::optional<HandView> hand_view_;
  Camera camera_;
  bool view_is_to_be_reset_ = true;  // at the next frame, from the box as it is then
  glm::vec2 origin_{0.0f};           // of the pane, in screen coordinates
  glm::vec2 size_{1.0f};
  Drag drag_ = Drag::none;
  glm::vec3 grabbed_{0.0f};  // where the hand is wanted, in view space
  int dragged_wall_ = 0;
  float wall_grab_offset_m_ = 0.0f;
  std::optional<int> marked_wall_;
  bool over_probe_ = false;
};

}  // namespace inkwell::window
