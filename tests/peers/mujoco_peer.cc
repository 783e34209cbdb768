// MuJoCo: hinge joint, ball against plane, elliptic cone. Its contacts are soft: it has no coefficient of restitution,
// but a stiffness and a damping (solref), which also say how fast friction stops slip.

#include <mujoco/mujoco.h>

#include <cstring>
#include <iostream>
#include <string>

#include "absl/strings/str_format.h"
#include "tests/peers/peer.h"
#include "tests/peers/spring_contact.h"

namespace ricochet::peers {
namespace {

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

// The greatest impedance that the engine takes; a smaller one would soften the contact beyond its spring.
constexpr double kImpedance = 0.9999;

std::string ModelText(const PendulumCase& c, double step, double contact_time) {
  const Rod rod(c);
  const SpringContact spring = SpringFor(c, contact_time);
  // Contacts are stated in their own frame and without friction where there is none, as the engine has a least
  // coefficient.
  const std::string contact = absl::StrFormat("condim='%d' friction='%.17g 0 0' solref='%.17g %.17g' solimp='%g %g 1'",
                                              c.friction > 0 ? 3 : 1, c.friction, -spring.stiffness / spring.mass,
                                              -spring.damping / spring.mass, kImpedance, kImpedance);
  return absl::StrFormat(
      "<mujoco>"
      "<option timestep='%.17g' gravity='0 0 0' cone='elliptic' solver='Newton' iterations='100' tolerance='1e-14'/>"
      "<worldbody>"
      "<geom type='plane' pos='0 %.17g 0' zaxis='0 1 0' size='20 20 1' %s/>"
      "<body>"
      "<inertial pos='%.17g %.17g 0' mass='%.17g' diaginertia='%.17g %.17g %.17g'/>"
      "<joint type='hinge' axis='0 0 1'/>"
      "<geom type='sphere' pos='%.17g %.17g 0' size='%g' %s/>"
      "</body>"
      "</worldbody>"
      "</mujoco>",
      step, -c.b, contact, rod.com_x, rod.com_y, rod.mass, rod.inertia_com, rod.inertia_com, rod.inertia_com, rod.tip_x,
      rod.tip_y, kTipRadius, contact);
}

mjModel* Load(const std::string& text) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "pendulum.xml", static_cast<int>(text.size()));
  std::memcpy(files->filedata[0], text.data(), text.size());
  char error[1000] = "";
  mjModel* model = mj_loadXML("pendulum.xml", files.get(), error, sizeof error);
  if (model == nullptr) std::cerr << "MuJoCo: " << error << '\n';
  mj_deleteVFS(files.get());
  return model;
}

class MujocoPeer final : public Peer {
 public:
  MujocoPeer(Setup setup, int steps_per_contact) : Peer(std::move(setup)), steps_per_contact_(steps_per_contact) {}

  void Prepare(const PendulumCase& c) override {
    data_.reset();
    model_.reset(Load(ModelText(c, setup().step_s, kContactTime)));
    if (model_ == nullptr) std::exit(EXIT_FAILURE);
    data_.reset(mj_makeData(model_.get()));
  }

  void Reset() override {
    mj_resetData(model_.get(), data_.get());
    data_->qvel[0] = kOmegaBefore;
  }

  void Run() override {
    // The first step only brings the ball into the surface. A contact that friction locks stays in touch for ever; four
    // times its length is enough for it to come to rest.
    mj_step(model_.get(), data_.get());
    for (int i = 0; i < 4 * steps_per_contact_; ++i) {
      mj_step(model_.get(), data_.get());
      if (data_->ncon == 0) return;
    }
  }

  AfterImpact After() const override { return AfterAt(data_->qvel[0]); }

 private:
  const int steps_per_contact_;
  std::unique_ptr<mjModel, DeleteModel> model_;
  std::unique_ptr<mjData, DeleteData> data_;
};

}  // namespace

Peers MujocoPeers() {
  Peers peers;
  for (const int steps : {10, 30, 100, 300, 1000}) {
    peers.push_back(
        std::make_unique<MujocoPeer>(Setup{"MuJoCo", "spring and damper", "elliptic cone, Newton's method",
                                           kContactTime / steps, 0, absl::StrFormat("contact of %d steps", steps),
                                           "solref (-k, -d), impedance 0.9999, impratio 1", steps == 30},
                                     steps));
  }
  return peers;
}

}  // namespace ricochet::peers
