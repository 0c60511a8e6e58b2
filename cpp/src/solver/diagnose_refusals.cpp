// SPDX-License-Identifier: BSD-3-Clause
#include "solver/diagnose_refusals.hpp"

#include <string>
#include <utility>
#include <vector>

#include "base/constants.hpp"
#include "base/message_text.hpp"

namespace iksel {
namespace {

std::string body_text(const Scene& scene, const std::string& name) {
  return (scene.attached().count(name) > 0 ? "object '" : "link '") + name + "'";
}

/// "box 'table'"
std::string obstacle_text(const Scene& scene, const std::string& name) {
  const Obstacle::Shape shape = scene.obstacles().at(name).shape;
  const bool is_half_space = shape == Obstacle::Shape::half_space;
  return std::string(is_half_space ? "half-space" : to_string(shape)) + " '" + name + "'";
}

/// "link 'a' touches box 'b' by 12 mm, link 'c' touches link 'd' by 3 mm"
std::string contacts_text(const Scene& scene, const std::vector<Contact>& contacts) {
  std::string list;
  for (const Contact& contact : contacts) {
    if (!list.empty()) list += ", ";
    list += body_text(scene, contact.link) + " touches ";
    list +=
        contact.is_obstacle ? obstacle_text(scene, contact.other) : body_text(scene, contact.other);
    if (contact.depth > kRounding) {
      list += " by " + number_text(1e3 * contact.depth, 3) + " mm";
    }
  }
  return list;
}

/// The answer whose deepest contact is the least deep; its contacts and the message go into `out`.
JointVector explain_collisions(const Scene& scene, const Solutions& refused, Diagnosis& out) {
  JointVector q;
  double least = kInfinity;
  for (const Result& answer : refused.all) {
    std::vector<Contact> contacts = scene.contacts(answer.q);
    const double deepest = contacts.empty() ? 0.0 : contacts.front().depth;
    if (deepest >= least) continue;
    least = deepest;
    q = answer.q;
    out.contacts = std::move(contacts);
  }
  out.cause = Cause::collision;
  out.message = "each of " + std::to_string(out.refused) + " answers collides; where they " +
                "overlap least, " + contacts_text(scene, out.contacts) +
                ": move the target or what is in the way";
  return q;
}

}  // namespace

SolveRequest opened(const SolveRequest& request) {
  SolveRequest open = request;
  open.filter = open.exact = nullptr;
  open.scene.reset();
  open.near.reset();
  open.objective = {};
  open.deadline = kInfinity;
  open.database_seeds = true;
  return open;
}

JointVector explain_refusals(
    const SolveRequest& request, Status status,
    FunctionRef<Solutions(const SolveAllOptions&, const SolveRequest&)> find_all, Diagnosis& out) {
  SolveAllOptions every;
  every.max = 512;
  const Solutions refused = find_all(every, opened(request));
  out.refused = static_cast<int>(refused.all.size());
  if (status == Status::in_collision && !refused.all.empty()) {
    return explain_collisions(*request.scene, refused, out);
  }
  out.cause = Cause::rejected;
  out.message = "the filter refused each of " + std::to_string(out.refused) +
                " answers: move the target, or let the filter pass more";
  return refused.all.empty() ? JointVector() : refused.all.front().q;
}

}  // namespace iksel
