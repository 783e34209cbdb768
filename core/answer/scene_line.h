// SceneLine: the scenes in which one number differs from that of a given scene.

#ifndef RICOCHET_CORE_ANSWER_SCENE_LINE_H_
#define RICOCHET_CORE_ANSWER_SCENE_LINE_H_

#include <optional>
#include <string>

#include "core/answer/differences.h"
#include "core/scene/field.h"
#include "ricochet/scene.h"

namespace ricochet {

// The scene with the number at `by` stated: friction that is not stated for sticking is that for sliding.
Scene Stating(const std::string& by, Scene scene);

class SceneLine {
 public:
  // `by` is the path of the number.
  SceneLine(Scene scene, const std::string& by);
  SceneLine(const SceneLine&) = delete;
  SceneLine& operator=(const SceneLine&) = delete;

  double number() const { return number_; }
  // The power of two that is the size of the number; that of its neighbours in a list if it is 0, or 1.
  double unit() const { return unit_; }
  // Takes the sample where the number is moved by `step`: nothing if the number cannot be there. Returns false once the
  // source is stopped.
  bool At(const SampleSource& source, double step, std::optional<Sample>& sample);

 private:
  Scene scene_;
  Field field_;
  double number_ = 0.0;
  double unit_ = 1.0;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_SCENE_LINE_H_
