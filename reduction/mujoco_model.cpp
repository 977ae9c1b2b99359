#include "reduction/mujoco_model.hpp"

#include "base/errors.hpp"
#include "base/files.hpp"
#include "base/index.hpp"
#include "base/toml_reader.hpp"
#include "base/units.hpp"
#include "base/xml_text.hpp"
#include "reduction/export_text.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>

namespace snare::reduction {

namespace {

using base::at;
using base::InputError;
using base::XmlElement;
using base::XmlText;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t most_includes = 100;

/// The text with every <include file="..."/> replaced by the content of the root element of that file.
std::string expanded(const std::filesystem::path& file) {
  std::string text = base::read_text(file);
  for (std::size_t count = 0;; ++count) {
    const XmlText xml = base::scan_xml(file.string(), text);
    const auto include = std::ranges::find(xml.elements, "include", &XmlElement::name);
    if (include == xml.elements.end()) return text;
    const std::string name = include->attribute("file").value_or("");
    if (count >= most_includes || name.empty())
      throw InputError({file.string(), include->line, "include", name,
                        name.empty() ? "must name a file"
                                     : "must not be one of more than 100: do files include each other?"});
    const std::filesystem::path path = file.parent_path() / name;
    const XmlText inner = base::scan_xml(path.string(), base::read_text(path));
    const XmlElement& root = inner.elements.front();
    text.replace(include->begin, include->end - include->begin,
                 inner.text.substr(root.open_end, root.close_begin - root.open_end));
  }
}

std::vector<double> numbers_of(const std::string& text) {
  std::vector<double> values;
  const char* now = text.data();
  const char* const end = now + text.size();
  while (now < end) {
    while (now < end && std::string_view(" \t\r\n+").find(*now) != std::string_view::npos) ++now;
    double value = 0.0;
    const auto [stopped, error] = std::from_chars(now, end, value);
    if (error != std::errc()) break;
    values.push_back(value);
    now = stopped;
  }
  return values;
}

bool within(const XmlText& xml, const XmlElement& inner, const char* name) {
  for (int k = inner.parent; k >= 0; k = xml.elements[at(k)].parent) {
    if (xml.elements[at(k)].name == name) return true;
  }
  return false;
}

/// What the default classes of a model say of its elements.
class Defaults {
 public:
  explicit Defaults(const XmlText& xml) : xml_(xml) {}

  /// An attribute of an element: its own, else that of its class, of the classes around that one and of the
  /// main class.
  [[nodiscard]] std::optional<std::string> attribute(const XmlElement& element, const char* key) const {
    if (const auto own = element.attribute(key)) return own;
    std::string name = element.attribute("class").value_or("");
    for (int k = element.parent; name.empty() && k >= 0; k = xml_.elements[at(k)].parent)
      name = xml_.elements[at(k)].attribute("childclass").value_or("");
    int scope = class_of(name);
    for (; scope >= 0 && xml_.elements[at(scope)].name == "default";
         scope = xml_.elements[at(scope)].parent) {
      for (const XmlElement& one : xml_.elements) {
        if (one.parent == scope && one.name == element.name)
          if (const auto value = one.attribute(key)) return value;
      }
    }
    return std::nullopt;
  }

 private:
  /// Element of a class; of the main one for an empty name; -1 for an unknown class.
  [[nodiscard]] int class_of(const std::string& name) const {
    for (std::size_t k = 0; k < xml_.elements.size(); ++k) {
      const XmlElement& one = xml_.elements[k];
      if (one.name != "default") continue;
      const bool main = one.parent < 0 || xml_.elements[at(one.parent)].name != "default";
      if (name.empty() ? main : one.attribute("class") == name) return static_cast<int>(k);
    }
    return -1;
  }

  const XmlText& xml_;
};

/// How the model writes angles.
struct Angles {
  double unit = base::degree;
  std::string order = "xyz";  // of Euler angles; small letters: axes that turn along

  explicit Angles(const XmlText& xml) {
    for (const XmlElement& one : xml.elements) {
      if (one.name != "compiler") continue;
      if (const auto angle = one.attribute("angle")) unit = *angle == "radian" ? 1.0 : base::degree;
      if (const auto sequence = one.attribute("eulerseq")) order = *sequence;
    }
  }
};

Matrix3d rotation_of(const XmlElement& element, const Angles& angles) {
  const auto values = [&](const char* key) { return numbers_of(element.attribute(key).value_or("")); };
  if (const auto q = values("quat"); q.size() == 4)
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  if (const auto a = values("axisangle"); a.size() == 4)
    return Eigen::AngleAxisd(angles.unit * a[3], Vector3d(a[0], a[1], a[2]).normalized()).toRotationMatrix();
  if (const auto e = values("euler"); e.size() == 3 && angles.order.size() == 3) {
    Matrix3d R = Matrix3d::Identity();
    for (std::size_t k = 0; k < 3; ++k) {
      const char letter = angles.order[k];
      const Vector3d axis = Vector3d::Unit((letter | 0x20) - 'x');
      const Matrix3d turn = Eigen::AngleAxisd(angles.unit * e[k], axis).toRotationMatrix();
      if (letter >= 'a') {
        R = R * turn;
      } else {
        R = turn * R;
      }
    }
    return R;
  }
  if (const auto v = values("xyaxes"); v.size() == 6) {
    const Vector3d x = Vector3d(v[0], v[1], v[2]).normalized();
    Vector3d y(v[3], v[4], v[5]);
    y = (y - y.dot(x) * x).normalized();
    return (Matrix3d() << x, y, x.cross(y)).finished();
  }
  if (const auto z = values("zaxis"); z.size() == 3)
    return Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), Vector3d(z[0], z[1], z[2]))
        .toRotationMatrix();
  return Matrix3d::Identity();
}

/// Pose of a body in the world, as the file places it.
Eigen::Isometry3d pose_of(const XmlText& xml, const XmlElement& body) {
  const Angles angles(xml);
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (const XmlElement* one = &body;; one = &xml.elements[at(one->parent)]) {
    if (one->name == "body" || one->name == "frame") {
      Eigen::Isometry3d local = Eigen::Isometry3d::Identity();
      const auto p = numbers_of(one->attribute("pos").value_or(""));
      if (p.size() == 3) local.translation() = Vector3d(p[0], p[1], p[2]);
      local.linear() = rotation_of(*one, angles);
      X = local * X;
    }
    if (one->parent < 0) return X;
  }
}

std::vector<const XmlElement*> joints_of(const XmlText& xml, const XmlElement& body) {
  std::vector<const XmlElement*> joints;
  for (const XmlElement& one : xml.elements) {
    if ((one.name == "joint" || one.name == "freejoint") && one.parent >= 0 &&
        &xml.elements[at(one.parent)] == &body)
      joints.push_back(&one);
  }
  return joints;
}

/// Where files that the model names are, seen from another folder: one more <compiler>; empty where it names
/// none.
std::string asset_folders(const XmlText& xml, const std::filesystem::path& model,
                          const std::filesystem::path& out) {
  const auto names_file = [&](const XmlElement& e) {
    return e.attribute("file") && (within(xml, e, "asset") || e.name == "skin");
  };
  if (std::ranges::none_of(xml.elements, names_file)) return {};
  std::string mesh, texture;
  for (const XmlElement& one : xml.elements) {
    if (one.name != "compiler") continue;
    if (const auto both = one.attribute("assetdir")) mesh = texture = *both;
    mesh = one.attribute("meshdir").value_or(mesh);
    texture = one.attribute("texturedir").value_or(texture);
  }
  const auto seen = [&](const std::string& folder) {
    const auto from = std::filesystem::absolute(out).lexically_normal();
    const auto there = std::filesystem::absolute(model.parent_path() / folder).lexically_normal();
    return base::xml_escaped(there.lexically_relative(from).generic_string());
  };
  return fmt::format("  <compiler meshdir=\"{}\" texturedir=\"{}\"/>\n", seen(mesh), seen(texture));
}

std::string listed(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all.empty() ? "none with a name" : all;
}

/// A name that begins a part's, of letters, digits and underscores.
std::string identifier(const std::string& name) {
  std::string safe;
  for (const char c : name) safe += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return safe;
}

}  // namespace

/// The body, its joint and how a law is tied to it.
struct MujocoTarget::Parts {
  XmlText xml;
  const XmlElement* body = nullptr;
  // the only one, a slide joint of a body that stands still otherwise; null: another body
  const XmlElement* joint = nullptr;
  MujocoTie tie;

  Parts(const MujocoTarget& target, const MujocoMeeting& meeting, const MujocoLaw& law)
      : xml(base::scan_xml(target.file_.string(), target.text_)) {
    for (const XmlElement& one : xml.elements) {
      if (one.name == "body" && one.attribute("name") == meeting.body && within(xml, one, "worldbody"))
        body = &one;
    }
    if (body == nullptr) {
      const std::vector<std::string> known = target.bodies();
      const std::string nearest = base::nearest_word(meeting.body, known);
      throw InputError({"", 0, "--body", meeting.body,
                        "must be a body of " + target.file_.string() +
                            (nearest.empty() ? "" : "; did you mean " + nearest + "?") +
                            "; there are: " + listed(known)});
    }
    tie.name = fmt::format("snare_{}_{}", identifier(meeting.body), position_name(law.position));
    tie.advance = tie.first_touch = meeting.advance;
    tie.point = meeting.point;
    for (const XmlElement& one : xml.elements) {
      if (one.attribute("name").value_or("").starts_with(tie.name + "_"))
        throw InputError({target.file_.string(), one.line, "name", one.attribute("name").value_or(""),
                          "must not be there already: this law is on the body"});
    }
    find_joint(meeting);
  }

 private:
  void find_joint(const MujocoMeeting& meeting) {
    const Defaults defaults(xml);
    bool moves = false, carried = false;
    for (const XmlElement* one = body;; one = &xml.elements[at(one->parent)]) {
      const bool movable = !joints_of(xml, *one).empty() || one->attribute("mocap") == "true";
      (one == body ? moves : carried) |= one->name == "body" && movable;
      if (one->parent < 0) break;
    }
    if (!moves && !carried)
      throw InputError({xml.file, body->line, "--body", meeting.body,
                        "must be able to move: neither this body nor one that carries it has a joint"});
    const std::vector<const XmlElement*> joints = joints_of(xml, *body);
    tie.axis = meeting.axis.value_or(Vector3d::UnitY()).normalized();
    const bool slides =
        joints.size() == 1 && joints[0]->name == "joint" && defaults.attribute(*joints[0], "type") == "slide";
    if (!slides || carried) return;
    const auto written = numbers_of(defaults.attribute(*joints[0], "axis").value_or("0 0 1"));
    const Vector3d along =
        written.size() == 3 ? Vector3d(written[0], written[1], written[2]).normalized() : Vector3d::UnitZ();
    if (meeting.axis && tie.axis.cross(along).norm() > 1e-6)
      throw InputError({xml.file, joints[0]->line, "--axis",
                        fmt::format("{} {} {}", (*meeting.axis)[0], (*meeting.axis)[1], (*meeting.axis)[2]),
                        fmt::format("must be along the body's only joint, a slide along {} {} {}", along[0],
                                    along[1], along[2])});
    joint = joints[0];
    tie.coefficient = meeting.axis && tie.axis.dot(along) < 0.0 ? -1.0 : 1.0;
    tie.axis = tie.coefficient * along;
    const auto reference = numbers_of(defaults.attribute(*joint, "ref").value_or("0"));
    tie.first_touch = meeting.advance + tie.coefficient * (reference.empty() ? 0.0 : reference[0]);
    tie.joint = base::xml_escaped(joint->attribute("name").value_or(tie.name + "_joint"));
  }
};

MujocoTarget::MujocoTarget(const std::filesystem::path& file) : file_(file), text_(expanded(file)) {
  const XmlText xml = base::scan_xml(file_.string(), text_);
  if (xml.elements.front().name != "mujoco")
    throw InputError({file_.string(), xml.elements.front().line, "root",
                      "<" + xml.elements.front().name + ">", "must be a model of MuJoCo: <mujoco>"});
}

std::vector<std::string> MujocoTarget::bodies() const {
  const XmlText xml = base::scan_xml(file_.string(), text_);
  std::vector<std::string> names;
  for (const XmlElement& one : xml.elements) {
    if (one.name != "body" || !within(xml, one, "worldbody")) continue;
    if (const auto name = one.attribute("name")) names.push_back(*name);
  }
  return names;
}

MujocoModel MujocoTarget::with(const MujocoLaw& law, MujocoForm form, const MujocoMeeting& meeting,
                               const std::filesystem::path& out) const {
  Parts parts(*this, meeting, law);
  const MujocoTie& tie = parts.tie;
  MujocoModel model;
  model.fixed = parts.joint != nullptr;
  MujocoTie spatial = tie;
  if (!model.fixed) spatial.first_touch = mujoco_far_site + meeting.advance;
  const MujocoTie& used = model.fixed ? tie : spatial;
  std::vector<std::pair<std::size_t, std::string>> insertions;
  if (model.fixed && !parts.joint->attribute("name"))
    insertions.emplace_back(parts.joint->name_end, fmt::format(" name=\"{}\"", tie.joint));
  const std::string pin = mujoco_pin(law, form, used);
  if (!pin.empty()) insertions.emplace_back(parts.body->open_end, "\n" + pin);
  std::string tail = asset_folders(parts.xml, file_, out);
  const std::string anchors = mujoco_anchors(law, form, used);
  if (!anchors.empty()) {
    const Eigen::Isometry3d X = pose_of(parts.xml, *parts.body);
    const Eigen::Quaterniond q(X.linear());
    const Vector3d p = X.translation();
    tail += fmt::format(
        "  <worldbody>\n    <body name=\"{}_anchor\" pos=\"{} {} {}\" quat=\"{} {} {} {}\">\n{}    </body>\n "
        " "
        "</worldbody>\n",
        tie.name, p[0], p[1], p[2], q.w(), q.x(), q.y(), q.z(), anchors);
  }
  const double from = used.first_touch;
  tail += fmt::format(
      "  <tendon>\n{0}  </tendon>\n  <custom>\n    <numeric name=\"{1}_range\" data=\"{2} {3}\"/>\n  "
      "</custom>\n"
      "  <sensor>\n    <tendonpos name=\"{1}_now\" tendon=\"{1}_1\"/>\n  </sensor>\n",
      mujoco_tendons(law, form, used), tie.name, from, from + law.end);
  insertions.emplace_back(
      parts.xml.elements.front().close_begin,
      fmt::format(
          "\n  <!-- The snare wire on body {}: {}.\n       Readers: {}. {}_range is the length of its first "
          "tendon within the range [m]. -->\n{}",
          tie.name, mujoco_words(law, form), readers_of(form), tie.name, tail));
  model.text = base::with_insertions(parts.xml.text, std::move(insertions));
  if (!model.fixed)
    model.notes.push_back(
        fmt::format("the push is along {:.4g} {:.4g} {:.4g} of the world, where the model places body {}",
                    (pose_of(parts.xml, *parts.body).linear() * tie.axis)[0],
                    (pose_of(parts.xml, *parts.body).linear() * tie.axis)[1],
                    (pose_of(parts.xml, *parts.body).linear() * tie.axis)[2], meeting.body));
  if (!model.fixed && law.dashpot && form == MujocoForm::law)
    model.notes.push_back("the damping of impacts is left out: it needs a body with one slide joint");
  return model;
}

}  // namespace snare::reduction
