// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "dcnn/core/error.h"
#include "dcnn/core/json.h"
#include "dcnn/data/rotation.h"
#include "dcnn/identification/payload.h"

namespace dcnn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kMillimetre = 1e-3, kStandardGravity = 9.81;
constexpr const char* kFrame =
    "Frame: the flange E, whose pose the robot reports. SI units unless said. Written by "
    "dcnn-identify.";

/// The shortest decimals that read back as the same double.
std::string number(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

std::string list(const Eigen::VectorXd& values, const std::string& between) {
  std::string text;
  for (Index i = 0; i < values.size(); ++i) text += (i > 0 ? between : "") + number(values[i]);
  return text;
}

/// ixx, ixy, ixz, iyy, iyz, izz; zeros without an inertia.
struct Six {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  explicit Six(const PayloadBody& payload) {
    if (!payload.inertia_com) return;
    const Matrix3d& I = *payload.inertia_com;
    xx = I(0, 0), xy = I(0, 1), xz = I(0, 2), yy = I(1, 1), yz = I(1, 2), zz = I(2, 2);
  }
};

/// What the comment must say of numbers that nobody measured.
std::string caution(const PayloadBody& payload) {
  std::string words = payload.inertia_com ? "" : " The inertia is unknown and written as 0.";
  if (!payload.assumed.empty()) words += " " + not_identified(payload);
  return words;
}

std::string urdf(const PayloadBody& p) {
  const Six i(p);
  return "<?xml version=\"1.0\"?>\n<!-- " + std::string(kFrame) +
         " Inertia about the centre of mass, axes of E." + caution(p) + " -->\n" +
         "<robot name=\"payload\">\n  <link name=\"payload\">\n    <inertial>\n" +
         "      <origin xyz=\"" + list(p.com, " ") + "\" rpy=\"0 0 0\"/>\n" +
         "      <mass value=\"" + number(p.mass) + "\"/>\n" + "      <inertia ixx=\"" +
         number(i.xx) + "\" ixy=\"" + number(i.xy) + "\" ixz=\"" + number(i.xz) + "\" iyy=\"" +
         number(i.yy) + "\" iyz=\"" + number(i.yz) + "\" izz=\"" + number(i.zz) +
         "\"/>\n    </inertial>\n  </link>\n</robot>\n";
}

std::string sdf(const PayloadBody& p) {
  const Six i(p);
  const auto element = [](const std::string& name, double value) {
    return "          <" + name + ">" + number(value) + "</" + name + ">\n";
  };
  return "<?xml version=\"1.0\"?>\n<!-- " + std::string(kFrame) +
         " Inertia about the centre of mass, axes of E." + caution(p) + " -->\n" +
         "<sdf version=\"1.7\">\n  <model name=\"payload\">\n    <link name=\"payload\">\n" +
         "      <inertial>\n        <pose>" + list(p.com, " ") + " 0 0 0</pose>\n        <mass>" +
         number(p.mass) + "</mass>\n        <inertia>\n" + element("ixx", i.xx) +
         element("ixy", i.xy) + element("ixz", i.xz) + element("iyy", i.yy) + element("iyz", i.yz) +
         element("izz", i.zz) +
         "        </inertia>\n      </inertial>\n    </link>\n  </model>\n</sdf>\n";
}

std::string mujoco(const PayloadBody& p) {
  const Six i(p);
  Eigen::VectorXd six(6);
  six << i.xx, i.yy, i.zz, i.xy, i.xz, i.yz;
  const std::string inertia =
      p.inertia_com ? " fullinertia=\"" + list(six, " ") + "\"" : " diaginertia=\"1e-9 1e-9 1e-9\"";
  return "<!-- " + std::string(kFrame) +
         " fullinertia: xx yy zz xy xz yz about the centre of mass, axes of the body." +
         (p.inertia_com ? caution(p)
                        : std::string(" The inertia is unknown and written as 1e-9.") +
                              (p.assumed.empty() ? "" : " " + not_identified(p))) +
         " -->\n" + "<mujoco model=\"payload\">\n  <worldbody>\n    <body name=\"payload\">\n" +
         "      <inertial pos=\"" + list(p.com, " ") + "\" mass=\"" + number(p.mass) + "\"" +
         inertia + "/>\n    </body>\n  </worldbody>\n</mujoco>\n";
}

std::string ur(const PayloadBody& p) {
  const Six i(p);
  Eigen::VectorXd six(6);
  six << i.xx, i.yy, i.zz, i.xy, i.xz, i.yz;
  return "# " + std::string(kFrame) +
         "\n# Universal Robots: set_target_payload(mass [kg], centre "
         "of gravity [m],\n# inertia [kg*m^2] xx yy zz xy xz yz about the centre of gravity, axes "
         "of the tool flange);\n# PolyScope 5.10 or later, else set_payload(mass, centre)." +
         caution(p) + "\nset_target_payload(" + number(p.mass) + ", [" + list(p.com, ", ") +
         "], [" + list(six, ", ") + "])\n";
}

std::string franka(const PayloadBody& p) {
  const Six i(p);
  Eigen::VectorXd nine(9);
  nine << i.xx, i.xy, i.xz, i.xy, i.yy, i.yz, i.xz, i.yz, i.zz;
  Json transformation = Json::array();
  for (const int v : {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}) transformation.push_back(v);
  Json com = Json::array(), inertia = Json::array();
  for (const double v : p.com) com.push_back(v);
  for (const double v : nine) inertia.push_back(v);
  const Json json{
      {"_comment",
       std::string(kFrame) +
           " mass [kg], centerOfMass [m] in the flange, inertia [kg*m^2] about the centre "
           "of mass, column-major; transformation is the end effector's and left as "
           "identity." +
           caution(p)},
      {"mass", p.mass},
      {"centerOfMass", com},
      {"inertia", inertia},
      {"transformation", transformation}};
  return json.dump(2) + "\n";
}

/// The least turn about z, y, x that has these principal axes: they may change places and sides.
Matrix3d nearest_axes(const PayloadBody& p, Vector3d& moments) {
  const Matrix3d axes = p.axes();
  const Vector3d values = p.moments();
  std::array<Index, 3> order{0, 1, 2};
  Matrix3d best = axes;
  double most = -INFINITY;
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3d R;
      for (Index k = 0; k < 3; ++k) {
        R.col(k) = axes.col(order[static_cast<std::size_t>(k)]) * ((signs >> k) & 1 ? -1.0 : 1.0);
      }
      if (R.determinant() < 0.0 || R.trace() <= most) continue;
      most = R.trace();
      best = R;
      for (Index k = 0; k < 3; ++k) moments[k] = values[order[static_cast<std::size_t>(k)]];
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

std::string kuka(const PayloadBody& p) {
  Vector3d moments;
  const Vector3d abc = euler_from_rotation(nearest_axes(p, moments)) * 180.0 / M_PI;
  const Vector3d mm = p.com / kMillimetre;
  return "; " + std::string(kFrame) +
         "\n; KUKA: M [kg]; CM: centre of mass [mm] in FLANGE and the "
         "turn A B C [deg] about Z Y X of the\n; principal axes; J: principal moments [kg*m^2] "
         "about the centre of mass." +
         caution(p) + "\nDECL LOAD PAYLOAD={M " + number(p.mass) + ",CM {X " + number(mm.x()) +
         ",Y " + number(mm.y()) + ",Z " + number(mm.z()) + ",A " + number(abc.x()) + ",B " +
         number(abc.y()) + ",C " + number(abc.z()) + "},J {X " + number(moments.x()) + ",Y " +
         number(moments.y()) + ",Z " + number(moments.z()) + "}}\n";
}

std::string abb(const PayloadBody& p) {
  Vector3d moments;
  const Eigen::Quaterniond q(nearest_axes(p, moments));
  const Vector3d mm = p.com / kMillimetre;
  const Eigen::Vector4d aom(q.w(), q.x(), q.y(), q.z());
  return "! " + std::string(kFrame) +
         "\n! ABB loaddata: mass [kg], cog [mm] in the flange (tool0), "
         "aom: quaternion of the principal axes,\n! ix, iy, iz [kg*m^2] about the centre of "
         "gravity." +
         caution(p) + "\nPERS loaddata payload := [" + number(p.mass) + ",[" + list(mm, ",") +
         "],[" + list(aom, ",") + "]," + list(moments, ",") + "];\n";
}

std::string ros2_yaml(const PayloadBody& p) {
  return "# " + std::string(kFrame) +
         "\n# gravity_compensation of ros2_controllers' "
         "admittance_controller: CoG.pos [m] in frame.id, CoG.force = mass*9.81 [N].\n# "
         "payload: for other nodes; inertia ixx ixy ixz iyy iyz izz [kg*m^2] about the centre of "
         "mass." +
         caution(p) +
         "\nadmittance_controller:\n  ros__parameters:\n    "
         "gravity_compensation:\n      frame:\n        id: tool0\n      CoG:\n        pos: [" +
         list(p.com, ", ") + "]\n        force: " + number(p.mass * kStandardGravity) +
         "\npayload:\n  ros__parameters:\n    mass: " + number(p.mass) + "\n    com: [" +
         list(p.com, ", ") + "]\n    inertia: [" +
         [&] {
           const Six i(p);
           Eigen::VectorXd six(6);
           six << i.xx, i.xy, i.xz, i.yy, i.yz, i.zz;
           return list(six, ", ");
         }() +
         "]\n";
}

struct Format {
  const char *name, *file;
  std::string (*text)(const PayloadBody&);
};
constexpr Format kFormats[] = {{"urdf", "payload.urdf", urdf},
                               {"sdf", "payload.sdf", sdf},
                               {"mujoco", "payload.mujoco.xml", mujoco},
                               {"ur", "payload.script", ur},
                               {"franka", "payload.franka.json", franka},
                               {"kuka", "payload.kuka.src", kuka},
                               {"abb", "payload.abb.mod", abb},
                               {"ros2-yaml", "payload.ros2.yaml", ros2_yaml}};

const Format& format_of(const std::string& name) {
  const auto* found = std::find_if(std::begin(kFormats), std::end(kFormats),
                                   [&](const Format& f) { return name == f.name; });
  require(found != std::end(kFormats), Exit::kUsage, "unknown payload format '", name, "'");
  return *found;
}

}  // namespace

std::vector<std::string> payload_formats() {
  std::vector<std::string> names;
  for (const Format& format : kFormats) names.emplace_back(format.name);
  return names;
}

std::string not_identified(const PayloadBody& payload) {
  struct Word {
    const char *key, *name, *value;
  };
  static constexpr Word kWords[] = {
      {"mass_kg", "mass", "the likeliest mass"},
      {"com_m", "centre of mass", "0 for each coordinate that is not shown"},
      {"inertia_kgm2", "inertia",
       "that of a body of 3 cm radius of gyration about its centre of mass"}};
  std::string names, values;
  for (const Word& word : kWords) {
    if (std::find(payload.assumed.begin(), payload.assumed.end(), word.key) ==
        payload.assumed.end()) {
      continue;
    }
    names += (names.empty() ? "" : " and ") + std::string(word.name);
    values += (values.empty() ? "" : ", ") + std::string(word.value);
  }
  if (names.empty()) return "";
  return "NOT IDENTIFIED: the recordings do not show the " + names +
         "; written is an assumption (" + values + ").";
}

std::string payload_file(const std::string& format) { return format_of(format).file; }

std::string payload_text(const std::string& format, const PayloadBody& payload) {
  return format_of(format).text(payload);
}

}  // namespace dcnn
