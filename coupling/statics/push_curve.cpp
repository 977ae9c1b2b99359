#include "coupling/statics/push_curve.hpp"

namespace snare::coupling {

std::string to_string(PushEvent::Kind kind) {
  switch (kind) {
    case PushEvent::Kind::first_touch:
      return "first touch";
    case PushEvent::Kind::lift_off:
      return "lift-off";
    case PushEvent::Kind::touch:
      return "touch";
    case PushEvent::Kind::slip_begins:
      return "slip begins";
    case PushEvent::Kind::slip_ends:
      return "slip ends";
    case PushEvent::Kind::wrap_begins:
      return "wrap begins";
    case PushEvent::Kind::wrap_ends:
      return "wrap ends";
    case PushEvent::Kind::mount_slips:
      return "mount slips";
    case PushEvent::Kind::mount_holds:
      return "mount holds";
    case PushEvent::Kind::fold:
      return "fold";
    case PushEvent::Kind::bifurcation:
      return "bifurcation";
    case PushEvent::Kind::snap:
      return "snap";
  }
  return "unknown";
}

}  // namespace snare::coupling
