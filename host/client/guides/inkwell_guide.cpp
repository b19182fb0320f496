// Referencing: compares the pose of the stylus in the inkwell with the inkwell angles.
#include <memory>

#include "host/client/guides/guides.hpp"

#include "host/client/guides/joint_motion.hpp"

namespace inkwell::guides {
namespace {

Plan plan_inkwell(const Choices&) {
  Plan plan;
  plan.steps.push_back(std::make_unique<RestInInkwell>(plan.findings, true));
  return plan;
}

}  // namespace

const Offer inkwell_guide{"calibrate", "inkwell", "Reference in the inkwell",
                          "The stylus rests in the inkwell, and the pose there is compared with the arm's description.",
                          plan_inkwell};

}  // namespace inkwell::guides
