// SPDX-License-Identifier: Apache-2.0
// Laws without a name, as members of a fit.
#pragma once

#include "dcnn/discovery/discover.h"
#include "diagnosis/scan.h"

namespace dcnn {

/// Laws and the members that they are.
struct Laws {
  std::vector<discovery::Discovered> found;
  std::vector<Member> members;
};

Json law_json(const discovery::Discovered& found, const law::Terms& terms = law::tool_terms());

/// What a law must gain beyond the price of its numbers, of chi-square: more where a number costs
/// more, for laws err by more than the noise (a machine).
double least_gain_of_law(const Setting& setting);

/// The laws of a residual that gain as much; where a number costs more, established ones, for
/// another form may be the error of the laws that are known.
Laws worthy_laws(const Setting& setting, const JointFit& fit);

/// The same where the chain bears out what they promised; else none.
Laws borne_out(const Setting& setting, const JointFit& names);
/// The same of laws of known form, which are fitted again and not looked for.
Laws borne_out_again(const Setting& setting, const JointFit& names, const Laws& laws);

/// Whether the form of each is established: an approximation leaves nothing and may yet be none.
bool are_established(const Laws& laws);
/// All but one.
Laws without(Laws laws, std::size_t k);
/// Those that are among the members of a fit: beside other names one may have gone.
Laws those_in(const std::vector<Member>& members, Laws laws);

int fitted_numbers(const discovery::Discovered& law);
/// Numbers that were fitted, of laws and of names.
int numbers_of(const Laws& laws, const std::vector<Member>& members);

}  // namespace dcnn
