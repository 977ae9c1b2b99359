#include "coupling/dynamics/result.hpp"

namespace snare::coupling {

std::string to_string(MotionEvent::Kind kind) {
  switch (kind) {
    case MotionEvent::Kind::touch:
      return "touch";
    case MotionEvent::Kind::lift_off:
      return "lift_off";
    case MotionEvent::Kind::stick:
      return "stick";
    case MotionEvent::Kind::slip:
      return "slip";
  }
  return "";
}

}  // namespace snare::coupling
