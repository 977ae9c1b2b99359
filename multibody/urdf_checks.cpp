#include "base/toml_reader.hpp"
#include "multibody/urdf.hpp"

#include <fmt/format.h>
#include <tinyxml.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

namespace snare::multibody {

namespace {

using base::InputProblem;

/// Offsets beyond this are taken for millimetres [m].
constexpr double largest_offset = 1000.0;
/// Radii of gyration outside these are taken for other units than kg and m [m].
constexpr double smallest_gyration = 1e-4, largest_gyration = 1000.0;

/// A URDF file nests its elements six deep; beyond this it is none.
constexpr std::size_t deepest = 64;
/// The dynamics go with the square and, for natural frequencies, with the cube of the number of links; no arm
/// has as many.
constexpr std::size_t most_links = 2000;

struct JointEnds {
  std::string name, parent, child;
  int line = 0;
};

/// Collects the problems of one file.
class Checker {
 public:
  explicit Checker(std::string file) : file_(std::move(file)) {}

  std::vector<InputProblem> check(const std::string& text) {
    if (!scan(text)) return std::move(problems_);
    TiXmlDocument document;
    document.SetTabSize(1);
    document.Parse(text.c_str());
    if (document.Error()) {
      std::string what = document.ErrorDesc();
      if (!what.empty() && what.back() == '.') what.pop_back();
      add(document.ErrorRow(), "", "", "is no XML: " + what);
      return std::move(problems_);
    }
    const TiXmlElement* robot = document.RootElement();
    if (robot == nullptr || robot->ValueStr() != "robot") {
      add(robot == nullptr ? 0 : robot->Row(), "", robot == nullptr ? "" : "<" + robot->ValueStr() + ">",
          "must be a <robot> element");
      return std::move(problems_);
    }
    if (const int line = line_of_macro(*robot); line > 0) {
      add(line, "", "", "is raw xacro: run `xacro FILE.xacro > FILE.urdf` and name that file");
      return std::move(problems_);
    }
    static_cast<void>(name_of(*robot, "robot"));
    for (const TiXmlElement* e = robot->FirstChildElement("link"); e != nullptr;
         e = e->NextSiblingElement("link"))
      link(*e);
    for (const TiXmlElement* e = robot->FirstChildElement("joint"); e != nullptr;
         e = e->NextSiblingElement("joint"))
      joint(*e);
    if (links_.empty()) add(robot->Row(), "robot", "", "must have at least one <link>");
    if (links_.size() > most_links) {
      add(robot->Row(), "robot", fmt::format("{} links", links_.size()),
          fmt::format("must have at most {}", most_links));
      return std::move(problems_);
    }
    closure();
    std::stable_sort(problems_.begin(), problems_.end(),
                     [](const InputProblem& a, const InputProblem& b) { return a.line < b.line; });
    return std::move(problems_);
  }

 private:
  void add(int line, const std::string& key, const std::string& value, const std::string& requirement) {
    problems_.push_back({file_, line, key, value, requirement});
  }

  /// What must be known before the file is given to a parser that calls itself for every element within
  /// another: how deep they stand, and that no document type says what they are. False where it is refused.
  bool scan(const std::string& text) {
    int line = 1;
    std::size_t depth = 0;
    const auto skip_to = [&](std::size_t at, std::string_view end) {
      const std::size_t found = text.find(end, at);
      const std::size_t stop = found == std::string::npos ? text.size() : found + end.size();
      line += static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(at),
                                          text.begin() + static_cast<std::ptrdiff_t>(stop), '\n'));
      return stop;
    };
    for (std::size_t at = 0; at < text.size();) {
      const std::string_view rest = std::string_view(text).substr(at);
      if (rest.starts_with("<!--")) {
        at = skip_to(at, "-->");
      } else if (rest.starts_with("<![CDATA[")) {
        at = skip_to(at, "]]>");
      } else if (rest.starts_with("<!")) {
        add(line, "<!DOCTYPE", "", "must not be there: a robot description has no document type");
        return false;
      } else if (rest.starts_with("<?")) {
        at = skip_to(at, "?>");
      } else if (rest.starts_with("</")) {
        if (depth > 0) --depth;
        at = skip_to(at, ">");
      } else if (rest.starts_with("<")) {
        const int first_line = line;
        char quote = '\0';  // a '>' within an attribute's value ends nothing
        for (; at < text.size() && (quote != '\0' || text[at] != '>'); ++at) {
          if (text[at] == '\n') ++line;
          if (quote == text[at])
            quote = '\0';
          else if (quote == '\0' && (text[at] == '"' || text[at] == '\''))
            quote = text[at];
        }
        at = std::min(at + 1, text.size());
        if (text[at - 1] == '>' && text[at - 2] == '/') continue;
        if (++depth > deepest) {
          add(first_line, "", "", fmt::format("must not nest elements more than {} deep", deepest));
          return false;
        }
      } else {
        if (text[at] == '\n') ++line;
        ++at;
      }
    }
    return true;
  }

  /// Line of the first element or expression that xacro has still to work out; 0 where there is none.
  static int line_of_macro(const TiXmlElement& e) {
    if (e.ValueStr().starts_with("xacro:")) return e.Row();
    for (const TiXmlAttribute* a = e.FirstAttribute(); a != nullptr; a = a->Next())
      if (a->ValueStr().find("${") != std::string::npos || a->ValueStr().find("$(") != std::string::npos)
        return e.Row();
    for (const TiXmlElement* child = e.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement())
      if (const int line = line_of_macro(*child); line > 0) return line;
    return 0;
  }

  std::string name_of(const TiXmlElement& e, const std::string& kind) {
    const char* name = e.Attribute("name");
    if (name == nullptr || *name == '\0') {
      add(e.Row(), kind + ".name", "", "must be given");
      return {};
    }
    return name;
  }

  /// Numbers of an attribute; none after a problem.
  std::vector<double> numbers(const TiXmlElement& e, const char* attribute, const std::string& key,
                              std::size_t count) {
    const char* written = e.Attribute(attribute);
    const std::string wanted = count == 1 ? "must be a number" : fmt::format("must be {} numbers", count);
    if (written == nullptr) {
      add(e.Row(), key, "", wanted);
      return {};
    }
    const std::string_view text(written);
    std::vector<double> values;
    std::size_t at = 0;
    bool sound = true;
    while (sound && (at = text.find_first_not_of(" \t\n\r", at)) != std::string_view::npos) {
      const std::size_t end = std::min(text.find_first_of(" \t\n\r", at), text.size());
      const std::size_t first = at + (text[at] == '+' ? 1 : 0);
      double value = 0.0;
      const auto [stopped, error] = std::from_chars(text.data() + first, text.data() + end, value);
      sound = error == std::errc() && stopped == text.data() + end && std::isfinite(value);
      values.push_back(value);
      at = end;
    }
    if (!sound || values.size() != count) {
      add(e.Row(), key, fmt::format("\"{}\"", written), wanted);
      return {};
    }
    return values;
  }

  void origin(const TiXmlElement& owner, const std::string& key) {
    const TiXmlElement* e = owner.FirstChildElement("origin");
    if (e == nullptr) return;
    if (e->Attribute("xyz") != nullptr) {
      const std::vector<double> p = numbers(*e, "xyz", key + ".origin.xyz", 3);
      if (p.size() == 3 && std::hypot(p[0], p[1], p[2]) > largest_offset) {
        add(e->Row(), key + ".origin.xyz", fmt::format("\"{}\"", e->Attribute("xyz")),
            fmt::format("must be within {:g} m; URDF is in metres", largest_offset));
      }
    }
    if (e->Attribute("rpy") != nullptr) {
      const std::vector<double> rpy = numbers(*e, "rpy", key + ".origin.rpy", 3);
      for (const double angle : rpy) {
        if (std::abs(angle) <= 2.0 * EIGEN_PI + 1e-3) continue;
        add(e->Row(), key + ".origin.rpy", fmt::format("\"{}\"", e->Attribute("rpy")),
            "must be within +-2 pi; URDF is in radians");
        break;
      }
    }
  }

  void link(const TiXmlElement& e) {
    const std::string name = name_of(e, "link");
    const std::string key = "link[" + name + "]";
    if (!name.empty() && !links_.emplace(name, e.Row()).second) {
      add(e.Row(), key, "", fmt::format("must not be given twice; the first is in line {}", links_[name]));
    }
    const TiXmlElement* inertial = e.FirstChildElement("inertial");
    if (inertial == nullptr) return;
    origin(*inertial, key + ".inertial");
    double mass = 0.0;
    const TiXmlElement* mass_element = inertial->FirstChildElement("mass");
    if (mass_element == nullptr) {
      add(inertial->Row(), key + ".inertial", "", "must have a <mass>");
    } else {
      const std::vector<double> value = numbers(*mass_element, "value", key + ".inertial.mass", 1);
      if (!value.empty()) mass = value[0];
      if (!value.empty() && !(mass > 0.0)) {
        add(mass_element->Row(), key + ".inertial.mass", mass_element->Attribute("value"), "must be > 0 kg");
      }
    }
    const TiXmlElement* inertia = inertial->FirstChildElement("inertia");
    if (inertia == nullptr) {
      add(inertial->Row(), key + ".inertial", "", "must have an <inertia>");
      return;
    }
    std::vector<double> m;
    for (const char* entry : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}) {
      const std::vector<double> value = numbers(*inertia, entry, key + ".inertial.inertia." + entry, 1);
      if (!value.empty()) m.push_back(value[0]);
    }
    if (m.size() == 6) moments(*inertia, key + ".inertial.inertia", m, mass);
  }

  void moments(const TiXmlElement& e, const std::string& key, const std::vector<double>& m, double mass) {
    Eigen::Matrix3d matrix;
    matrix << m[0], m[1], m[2], m[1], m[3], m[4], m[2], m[4], m[5];
    const Eigen::Vector3d principal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix).eigenvalues();
    const std::string value =
        fmt::format("principal moments {:.4g}, {:.4g}, {:.4g}", principal[0], principal[1], principal[2]);
    if (!(principal[0] > 0.0)) {
      add(e.Row(), key, value, "must be positive definite");
    } else if (principal[2] >
               (principal[0] + principal[1]) * (1.0 + 1e-6)) {  // a flat body is the limit; files are rounded
      add(e.Row(), key, value,
          "must satisfy the triangle inequality: none larger than the sum of the others");
    } else if (mass > 0.0) {
      const double gyration = std::sqrt(principal[2] / mass);
      if (gyration < smallest_gyration || gyration > largest_gyration) {
        add(e.Row(), key, fmt::format("radius of gyration {:.3g} m", gyration),
            fmt::format("must be {:g} to {:g} m; URDF is in kg and m", smallest_gyration, largest_gyration));
      }
    }
  }

  void joint(const TiXmlElement& e) {
    JointEnds ends;
    ends.name = name_of(e, "joint");
    ends.line = e.Row();
    const std::string key = "joint[" + ends.name + "]";
    if (!ends.name.empty() && !joint_lines_.emplace(ends.name, e.Row()).second) {
      add(e.Row(), key, "",
          fmt::format("must not be given twice; the first is in line {}", joint_lines_[ends.name]));
    }
    const std::string type = e.Attribute("type") == nullptr ? "" : e.Attribute("type");
    static const std::set<std::string> types{"revolute", "continuous", "prismatic", "fixed", "floating"};
    if (types.count(type) == 0) {
      add(e.Row(), key + ".type", type.empty() ? "" : "\"" + type + "\"",
          "must be revolute, continuous, prismatic, fixed or floating");
    }
    if (e.FirstChildElement("mimic") != nullptr) {
      add(e.FirstChildElement("mimic")->Row(), key + ".mimic", "",
          "is not supported: every joint moves by itself");
    }
    origin(e, key);
    ends.parent = end(e, "parent", key);
    ends.child = end(e, "child", key);
    if (!ends.parent.empty() && ends.parent == ends.child) {
      add(e.Row(), key + ".child", "\"" + ends.child + "\"", "must not be the parent");
    } else if (!ends.child.empty()) {
      joints_.push_back(ends);
    }
    const TiXmlElement* axis = e.FirstChildElement("axis");
    if (axis != nullptr) {
      const std::vector<double> a = numbers(*axis, "xyz", key + ".axis", 3);
      if (a.size() == 3 && !(std::hypot(a[0], a[1], a[2]) > 1e-9)) {
        add(axis->Row(), key + ".axis", fmt::format("\"{}\"", axis->Attribute("xyz")), "must not be zero");
      }
    }
    limits(e, key, type);
    const TiXmlElement* dynamics = e.FirstChildElement("dynamics");
    for (const char* attribute : {"damping", "friction"}) {
      if (dynamics == nullptr || dynamics->Attribute(attribute) == nullptr) continue;
      const std::vector<double> value = numbers(*dynamics, attribute, key + ".dynamics." + attribute, 1);
      if (!value.empty() && !(value[0] >= 0.0))
        add(dynamics->Row(), key + ".dynamics." + attribute, dynamics->Attribute(attribute), "must be >= 0");
    }
  }

  void limits(const TiXmlElement& e, const std::string& key, const std::string& type) {
    const TiXmlElement* limit = e.FirstChildElement("limit");
    if (limit == nullptr) {
      if (type == "revolute" || type == "prismatic")
        add(e.Row(), key, "", "must have a <limit>; a continuous joint needs none");
      return;
    }
    double lower = 0.0, upper = 0.0;
    for (const char* attribute : {"lower", "upper", "effort", "velocity"}) {
      const bool required =
          std::string_view(attribute) == "effort" || std::string_view(attribute) == "velocity";
      if (!required && limit->Attribute(attribute) == nullptr) continue;
      const std::vector<double> value = numbers(*limit, attribute, key + ".limit." + attribute, 1);
      if (value.empty()) continue;
      if (std::string_view(attribute) == "lower") lower = value[0];
      if (std::string_view(attribute) == "upper") upper = value[0];
      if (required && !(value[0] >= 0.0)) {
        add(limit->Row(), key + ".limit." + attribute, limit->Attribute(attribute), "must be >= 0");
      }
    }
    if (lower > upper) {
      add(limit->Row(), key + ".limit.lower", fmt::format("{:g}", lower),
          fmt::format("must not exceed upper = {:g}", upper));
    }
  }

  std::string end(const TiXmlElement& joint, const char* which, const std::string& key) {
    const TiXmlElement* e = joint.FirstChildElement(which);
    const char* link = e == nullptr ? nullptr : e->Attribute("link");
    if (link == nullptr || *link == '\0') {
      add(joint.Row(), key + "." + which, "", "must name a link");
      return {};
    }
    if (links_.count(link) == 0) {
      std::vector<std::string> names;
      for (const auto& [name, line] : links_) names.push_back(name);
      const std::string nearest = base::nearest_word(link, names);
      add(e->Row(), key + "." + which, fmt::format("\"{}\"", link),
          "must be a link of this file" + (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
      return {};
    }
    return link;
  }

  /// Every link but one has one carrier, and the links hang together.
  void closure() {
    std::map<std::string, const JointEnds*> carrier;
    for (const JointEnds& j : joints_) {
      const auto [found, inserted] = carrier.emplace(j.child, &j);
      if (!inserted) {
        add(j.line, "joint[" + j.name + "].child", "\"" + j.child + "\"",
            "must not have a second parent: joint \"" + found->second->name + "\" carries it already");
      }
    }
    std::vector<std::string> roots;
    for (const auto& [name, line] : links_) {
      if (carrier.count(name) == 0) roots.push_back(name);
    }
    if (roots.size() > 1 && problems_.empty()) {
      std::string all;
      for (const std::string& name : roots) all += (all.empty() ? "\"" : ", \"") + name + "\"";
      add(0, "robot", all, "must have one root link; these are carried by no joint");
    }
    std::set<std::string> rooted;  // links that are known to lead to a root
    for (const auto& [name, line] : links_) {
      std::string link = name;
      std::vector<std::string> way;
      for (std::size_t steps = 0; carrier.count(link) != 0 && rooted.count(link) == 0; ++steps) {
        way.push_back(link);
        if (steps > links_.size()) {
          add(line, "link[" + name + "]", "", "must not be in a closed loop of joints");
          return;
        }
        link = carrier[link]->parent;
      }
      rooted.insert(way.begin(), way.end());
    }
  }

  std::string file_;
  std::vector<InputProblem> problems_;
  std::map<std::string, int> links_, joint_lines_;
  std::vector<JointEnds> joints_;
};

}  // namespace

std::vector<InputProblem> check_urdf(const std::string& file, const std::string& text) {
  return Checker(file).check(text);
}

}  // namespace snare::multibody
