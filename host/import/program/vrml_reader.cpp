#include <sys/stat.h>

#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Inventor/SbMatrix.h>
#include <Inventor/SoDB.h>
#include <Inventor/SoFullPath.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/VRMLnodes/SoVRMLCone.h>
#include <Inventor/VRMLnodes/SoVRMLCylinder.h>
#include <Inventor/VRMLnodes/SoVRMLExtrusion.h>
#include <Inventor/VRMLnodes/SoVRMLGroup.h>
#include <Inventor/VRMLnodes/SoVRMLIndexedFaceSet.h>
#include <Inventor/VRMLnodes/SoVRMLSphere.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/errors/SoReadError.h>
#include <Inventor/fields/SoSFBool.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoShape.h>

#include <fmt/format.h>

#include "host/import/error.hpp"
#include "host/import/program/object_readers.hpp"
#include "host/import/text_scanner.hpp"

namespace inkwell::importer {
namespace {

/// The first error of Coin, which reports errors in callbacks.
struct VrmlErrors {
  std::string first{};

  static void keep(const SoError* error, void* errors) {
    auto& first = static_cast<VrmlErrors*>(errors)->first;
    const std::string text = error->getDebugString().getString();
    // The shape does not depend on pictures.
    if (first.empty() && text.find("texture file") == text.npos) first = shortened(text);
  }

 private:
  /// "Coin read error: REASON\n\tOccurred at line   7 in /FOLDER/FILE" -> "REASON, line 7".
  static std::string shortened(std::string_view text) {
    constexpr std::string_view prefix = "Coin read error: ", location = "Occurred at line";
    if (text.starts_with(prefix)) text.remove_prefix(prefix.size());
    std::string reason(text.substr(0, text.find('\n')));
    if (const auto at = text.find(location); at != text.npos)
      reason += fmt::format(", line {}", TextScanner(text.substr(at + location.size())).word());
    return reason;
  }
};

/// Coin reads included files recursively, so a file that includes itself overflows the stack.
class GuardedInput : public SoInput {
 public:
  SbBool pushFile(const char* file) override {
    if (!refusal_.empty()) return FALSE;
    if (depth_ >= depth_max) {
      refusal_ =
          fmt::format("includes {}, which includes itself, directly or through other files. Remove this Inline node",
                      std::filesystem::path(file).filename().string());
      return FALSE;
    }
    if (!SoInput::pushFile(file)) {
      refusal_ = fmt::format("includes {}, which cannot be opened. Copy that file into the folder of the object", file);
      return FALSE;
    }
    struct stat status {};
    if (::stat(getCurFileName(), &status) == 0 && !S_ISREG(status.st_mode))
      refusal_ = fmt::format("includes {}, which is not a file. Remove this Inline node", file);
    ++depth_;
    return TRUE;
  }

  /// The end of the sentence about an included file, or an empty text.
  const std::string& refusal() const { return refusal_; }

 protected:
  SbBool popFile() override {
    if (depth_ > 0) --depth_;
    return SoInput::popFile();
  }

 private:
  static constexpr int depth_max = 16;
  int depth_ = 0;
  std::string refusal_{};
};

/// Many files declare concave faces as convex, and Coin would split these faces into overlapping triangles.
template <class Node>
void allow_concave_faces(SoNode* scene) {
  SoSearchAction search;
  search.setType(Node::getClassTypeId());
  search.setInterest(SoSearchAction::ALL);
  search.setSearchingAll(TRUE);
  search.apply(scene);
  const SoPathList& paths = search.getPaths();
  // Only a full path leads to the children of VRML groups.
  for (int i = 0; i < paths.getLength(); ++i)
    static_cast<Node*>(static_cast<SoFullPath*>(paths[i])->getTail())->convex = FALSE;
}

/// The triangles of a scene.
class VrmlTriangles {
 public:
  explicit VrmlTriangles(SoNode* scene) {
    SoCallbackAction action;
    action.addPreCallback(SoVRMLSphere::getClassTypeId(), add_sphere, this);
    action.addPreCallback(SoVRMLCylinder::getClassTypeId(), add_cylinder, this);
    action.addPreCallback(SoVRMLCone::getClassTypeId(), add_cone, this);
    action.addTriangleCallback(SoShape::getClassTypeId(), add_triangle, this);
    action.apply(scene);
  }

  bool are_too_many() const { return content_.faces.size() > triangles_max; }
  FileContent take() { return std::move(content_); }

 private:
  /// Sides of a circle. The flat faces of a sphere of 50 mm are 27 um too deep.
  static constexpr std::uint32_t sides = 96;

  /// A ring of a body of revolution about the y axis; a radius of 0 is a single vertex.
  struct Ring {
    double radius, y;
  };

  std::uint32_t add_vertex(SoCallbackAction* action, const SbVec3f& own) {
    SbVec3f point;
    action->getModelMatrix().multVecMatrix(own, point);
    content_.vertices.emplace_back(point[0], point[1], point[2]);
    return static_cast<std::uint32_t>(content_.vertices.size() - 1);
  }

  void add_face(SoCallbackAction* action, std::uint32_t a, std::uint32_t b, std::uint32_t c, bool is_clockwise) {
    const bool is_mirrored = action->getModelMatrix().det3() < 0;
    if (is_clockwise != is_mirrored) std::swap(b, c);
    content_.faces.push_back({a, b, c});
  }

  /// Coin returns the corners in the order of the file, even if `ccw` is FALSE or if the transform mirrors.
  static void add_triangle(void* self, SoCallbackAction* action, const SoPrimitiveVertex* first,
                           const SoPrimitiveVertex* second, const SoPrimitiveVertex* third) {
    auto& triangles = *static_cast<VrmlTriangles*>(self);
    if (triangles.are_too_many()) return;
    const std::uint32_t a = triangles.add_vertex(action, first->getPoint());
    const std::uint32_t b = triangles.add_vertex(action, second->getPoint());
    const std::uint32_t c = triangles.add_vertex(action, third->getPoint());
    triangles.add_face(action, a, b, c, is_clockwise(action));
  }

  /// The rings go from the top to the bottom, and start and end with a radius of 0. The bodies of Coin have few sides,
  /// and a gap where the first side meets the last one.
  void add_body(SoCallbackAction* action, std::span<const Ring> rings) {
    if (are_too_many()) return;
    std::vector<std::uint32_t> upper, lower;
    for (const Ring& ring : rings) {
      lower.clear();
      for (std::uint32_t side = 0; side < sides; ++side) {
        if (ring.radius == 0 && side > 0) {
          lower.push_back(lower[0]);
          continue;
        }
        const double angle_rad = 2 * std::numbers::pi * side / sides;
        lower.push_back(add_vertex(
            action, SbVec3f(static_cast<float>(ring.radius * std::sin(angle_rad)), static_cast<float>(ring.y),
                            static_cast<float>(ring.radius * std::cos(angle_rad)))));
      }
      for (std::uint32_t side = 0; side < upper.size(); ++side) {
        const std::uint32_t next = (side + 1) % sides;
        if (lower[side] != lower[next]) add_face(action, upper[side], lower[side], lower[next], false);
        if (upper[side] != upper[next]) add_face(action, upper[side], lower[next], upper[next], false);
      }
      upper = lower;
    }
  }

  static SoCallbackAction::Response add_sphere(void* self, SoCallbackAction* action, const SoNode* node) {
    const double radius = static_cast<const SoVRMLSphere*>(node)->radius.getValue();
    std::vector<Ring> rings{{0, radius}};
    for (std::uint32_t ring = 1; ring < sides / 2; ++ring) {
      const double angle_rad = 2 * std::numbers::pi * ring / sides;
      rings.push_back({radius * std::sin(angle_rad), radius * std::cos(angle_rad)});
    }
    rings.push_back({0, -radius});
    static_cast<VrmlTriangles*>(self)->add_body(action, rings);
    return SoCallbackAction::PRUNE;
  }

  static SoCallbackAction::Response add_cylinder(void* self, SoCallbackAction* action, const SoNode* node) {
    const auto& cylinder = *static_cast<const SoVRMLCylinder*>(node);
    const double radius = cylinder.radius.getValue(), top = 0.5 * cylinder.height.getValue();
    std::vector<Ring> rings{{radius, top}, {radius, -top}};
    if (cylinder.top.getValue()) rings.insert(rings.begin(), {0, top});
    if (cylinder.bottom.getValue()) rings.push_back({0, -top});
    if (!cylinder.side.getValue()) return SoCallbackAction::CONTINUE;
    static_cast<VrmlTriangles*>(self)->add_body(action, rings);
    return SoCallbackAction::PRUNE;
  }

  static SoCallbackAction::Response add_cone(void* self, SoCallbackAction* action, const SoNode* node) {
    const auto& cone = *static_cast<const SoVRMLCone*>(node);
    const double radius = cone.bottomRadius.getValue(), top = 0.5 * cone.height.getValue();
    std::vector<Ring> rings{{0, top}, {radius, -top}};
    if (cone.bottom.getValue()) rings.push_back({0, -top});
    if (!cone.side.getValue()) return SoCallbackAction::CONTINUE;
    static_cast<VrmlTriangles*>(self)->add_body(action, rings);
    return SoCallbackAction::PRUNE;
  }

  static bool is_clockwise(SoCallbackAction* action) {
    const SoField* field = action->getCurPathTail()->getField("ccw");
    if (field != nullptr && field->isOfType(SoSFBool::getClassTypeId()))
      return static_cast<const SoSFBool*>(field)->getValue() == FALSE;
    return action->getVertexOrdering() == SoShapeHints::CLOCKWISE;
  }

  FileContent content_{};
};

}  // namespace

FileContent read_vrml(const std::filesystem::path& file, const std::string& name) {
  SoDB::init();
  VrmlErrors errors;
  SoError::setHandlerCallback(VrmlErrors::keep, &errors);
  SoReadError::setHandlerCallback(VrmlErrors::keep, &errors);
  SoDebugError::setHandlerCallback([](const SoError*, void*) {}, nullptr);
  GuardedInput input;
  if (!input.openFile(file.c_str())) throw Error(fmt::format("{} cannot be opened. Check its permissions.", name));
  SoSeparator* const root = new SoSeparator;
  root->ref();
  SoNode* const scene = input.isFileVRML2() ? static_cast<SoNode*>(SoDB::readAllVRML(&input)) : SoDB::readAll(&input);
  if (!input.refusal().empty()) throw Error(fmt::format("{} {}.", name, input.refusal()));
  if (scene == nullptr || !errors.first.empty())
    throw Error(fmt::format("{} is not a valid VRML file ({}). Export the file again.", name,
                            errors.first.empty() ? "no scene" : errors.first));
  root->addChild(scene);
  allow_concave_faces<SoVRMLIndexedFaceSet>(root);
  allow_concave_faces<SoVRMLExtrusion>(root);
  VrmlTriangles triangles(root);
  if (triangles.are_too_many()) check_counts(0, triangles_max + 1, name);
  FileContent content = triangles.take();
  content.unit = Unit::meter;
  content.is_unit_doubtful = true;
  return content;
}

}  // namespace inkwell::importer
