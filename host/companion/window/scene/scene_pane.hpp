// The pane shows arm, sphere and walls, and handles the mouse.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "host/companion/window/device_desk/next_step.hpp"
#include "host/companion/window/device_desk/parameter_editor.hpp"
#include "host/companion/window/frame/picture_changes.hpp"
#include "host/companion/window/frame/picture_digest.hpp"
#include "host/companion/window/frame/style.hpp"
#include "host/companion/window/scene/camera.hpp"
#include "host/companion/window/scene/mouse_hand.hpp"
#include "host/companion/window/scene/scene_look.hpp"
#include "host/companion/window/scene/scene_model.hpp"
#include "host/companion/window/scene/scene_objects.hpp"
#include "host/companion/window/scene/scene_solids.hpp"

namespace inkwell::window {

struct ScenePaneInput {
  const Style& style;
  const std::optional<device::Pose>& pose;
  ParameterEditor& editor;
  MouseHand* hand;  ///< null without a virtual board
  double now_s;
  bool is_replay = false;                    ///< pose and parameters are from a recording
  const std::optional<NextStep>& next_step;  ///< shown on a card
  float covered_height = 0.0f;               ///< height of the banner below the buttons
  const SceneObjects& objects;
};

class Renderer;

class ScenePane {
 public:
  /// Requires an initialized OpenGL context.
  ScenePane();
  ~ScenePane();

  /// Handles the mouse and draws the labels in front of the picture of draw_scene(). Returns true if the user presses
  /// the button of the next step.
  bool draw(ImVec2 origin, ImVec2 size, const ScenePaneInput& input);
  void draw_scene(const Viewport& viewport, SceneLook look) const;
  /// Adds the state of mouse and simulated hand to the digest.
  void add_to(PictureDigest& digest) const;
  void reset_view() { view_is_to_be_reset_ = true; }

 private:
  enum class Drag : std::uint8_t { none, orbit, pan, hand, wall };

  void handle_mouse(const ScenePaneInput& input);
  /// The arrow keys rotate the view with Shift, move the view with Ctrl+Shift, and move the simulated hand with Ctrl.
  void handle_keys(const ScenePaneInput& input);
  void start_drag(const ScenePaneInput& input, glm::vec2 mouse);
  void continue_drag(const ScenePaneInput& input, glm::vec2 mouse, glm::vec2 moved);
  void end_drag(const ScenePaneInput& input);
  std::optional<int> wall_under(glm::vec2 mouse, float reach) const;
  glm::vec3 wall_handle(int wall) const;

  void note_handles() const;
  void draw_proxy_label(ImDrawList& list, const Style& style) const;
  void draw_wall_handles(ImDrawList& list, const Style& style) const;
  Box draw_force_label(ImDrawList& list, const Style& style) const;
  void draw_hand_label(ImDrawList& list, const Style& style, const Box& force_plate) const;
  void draw_contact_points(ImDrawList& list, const ScenePaneInput& input) const;
  void draw_progress(ImDrawList& list, const ScenePaneInput& input) const;
  void draw_footer(ImDrawList& list, const ScenePaneInput& input) const;
  void draw_labels(const ScenePaneInput& input) const;
  void draw_axes(ImDrawList& list, const Style& style) const;
  void draw_tools(const ScenePaneInput& input);
  /// Draws the card with the next step. Returns true if the button was pressed.
  bool draw_next_step(const ScenePaneInput& input);
  /// Returns the corner of a card of this size that does not cover the sphere. The card moves only if it must.
  glm::vec2 card_corner(glm::vec2 card, const ScenePaneInput& input);
  void draw_replay_border(const Style& style) const;
  /// Moves the camera so that the box and all objects are visible.
  void fit_view(const SceneObjects& objects);
  ImVec2 on_screen(glm::vec3 workspace_point_m) const;

  std::unique_ptr<Renderer> renderer_;
  SceneModel scene_{};
  std::vector<SceneObject> objects_;
  std::optional<HandView> hand_view_;
  Camera camera_;
  Camera fitted_camera_;             // of the last fit_view()
  std::uint64_t fitted_meshes_ = 0;  // SceneObjects::meshes_revision() of the last fit_view()
  bool view_is_to_be_reset_ = true;  // in the next frame
  glm::vec2 origin_{0.0f};           // of the pane, in screen coordinates
  glm::vec2 size_{1.0f};
  Drag drag_ = Drag::none;
  glm::vec3 grabbed_{0.0f};  // target of the hand in view space
  int dragged_wall_ = 0;
  float wall_grab_offset_m_ = 0.0f;
  std::optional<int> marked_wall_;
  bool over_probe_ = false;
  std::size_t card_position_ = 0;  ///< index into the possible positions of the card
  Box card_;                       ///< rectangle of the card in the previous frame
};

}  // namespace inkwell::window
