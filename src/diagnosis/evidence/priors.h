// SPDX-License-Identifier: Apache-2.0
// Every prior of the diagnosis, in one table (docs/develop/priors.md says where each comes from).
#pragma once

namespace dcnn::evidence::prior {

constexpr double kName = 0.04;  ///< probability of each listed effect, shared by its axes
/// Of a law that bends a commoner one, as a share of the latter's; in a search it costs one number
/// more. Also of one number in the place of several.
constexpr double kSpecial = 0.1;
constexpr double kUsualDelay = 0.1;  ///< mean of a delay's size [s]; exponential
/// On a machine, of a law that nearly every one has (dry and viscous friction, a weight off the
/// axis): even odds, for it may be small, or in its simulator.
constexpr double kCommon = 0.5;
constexpr double kUnknown = 0.12;   ///< of physics that no effect of the catalogue describes
constexpr double kSlowNoise = 0.1;  ///< of noise that grows below the floor's band
/// Of an axis whose reading is the reaction to its drive.
constexpr double kReaction = 0.2;
/// Density of a sensor's slow noise over its floor at most, in any octave.
constexpr double kMostSlowNoise = 100.0;
/// The same of noise of any spectrum, in any band, that depends on nothing.
constexpr double kMostFreeNoise = 3.0;
/// Corner [Hz] below which slow noise shows: log-uniform between these.
constexpr double kLeastCorner = 0.01, kMostCorner = 10.0;
/// Decades over which the size of an effect, in deviations of the noise over all rows, is
/// log-uniform.
constexpr double kDecades = 4.0;
/// Rms of a field of the unknown, in deviations of a block's noise: log-uniform between these.
constexpr double kLeastField = 0.003, kMostField = 300.0;
/// Deviation of each error of a force sensor's calibration (scale, crosstalk), as a share of what
/// it reads: of 0.02 that makers state and the 0.15 of the worst public recording.
constexpr double kCalibration = 0.1;
/// Relative deviation by which a law, or the motion that it acts on, may be wrong.
constexpr double kModelError = 0.003;
/// A name and an unknown along one axis of one driver [nats]: one cause is the rule.
constexpr double kSameCause = 20.0;
/// Gain of the unknown [nats] at which differences of evidence beside it count half: its functions
/// are some per cent off any law.
constexpr double kTempering = 60.0;
/// Deviation of what filtering the pose a little more or less changes, in units of that change.
constexpr double kFiltering = 1.5;
/// Deviation of a cable's or a creep's force at the first sample, as a share of its largest.
constexpr double kBeginning = 0.6;
/// Time [s] to within which the ends of an interval are known; they are uniform over the
/// recordings.
constexpr double kEdge = 0.2;
/// Probability that the structure is none of those that were weighed: shared by the four classes,
/// and taken off every name. A search meets no more than it looks for.
constexpr double kElsewhere = 0.04;
/// The same where something remains that no name explains, or a law without a name stands for it:
/// in another form that may hold what the name explains. Of names beside a law 34 of 41 acted in
/// the proof's mixed scenarios, 9 of 15 in those of another generator.
constexpr double kElsewhereBesideUnknown = 0.4;
/// The same on a machine, whose laws have more forms than the catalogue: of names that left nothing
/// but noise 154 of 179 acted in three sets of simulated machines, 90 of 118 in two new ones.
constexpr double kElsewhereOnMachine = 0.3;

/// Share of what names leave beyond noise that an approximation without a name explains at least
/// to take the place of one: even odds, for either is then further off than noise.
constexpr double kInPlaceOfName = 0.5;
/// Share of a machine's recordings that a collision or a hand disturbs at most: what is far off for
/// longer is a law that was not found.
constexpr double kMostForeign = 0.2;
/// Share that one line of the position makes at least of what varies above the motion's band, for
/// that band to hold it: faint ones are part of the noise.
constexpr double kLeastPositionLine = 0.1;
/// Of a name that fits a machine's recordings, before held-out data: even odds.
constexpr double kFittedOnMachine = 0.5;

// Of the search, in which differences of chi-square stand for the evidence.

/// Gain, in prices of a number, to name an effect without a number, with one, and for each further
/// one of an effect that is alone: chi-square that noise exceeds in 3 of a million trials (21.8,
/// 25.4, 28.5, 31.1 for 1 to 4). Beside others, which may be a little wrong, each pays its price.
constexpr double kTried = 1.2, kFirstNumber = 1.0, kFurtherNumber = 0.35;
/// The first of these on a machine, whose price is a share of what is left: laws there are only
/// nearly true.
constexpr double kTriedOnMachine = 2.0;
/// Deviations of a tool's noise that what its names leave is as large as, from which on the error
/// of laws is what is left, as always of a machine: no verdict of 24 sealed scenarios changed by
/// it.
constexpr double kSwamped = 30.0;
/// Error of a gain that is estimated along a tangent, as a share of it: in general, where readings
/// are rounded, and beside a law whose shape is at its bound.
constexpr double kTangentError = 0.01, kTangentErrorRounded = 0.4, kTangentErrorAtBound = 0.05;
/// What an exchange of members gains at least, in prices of a number.
constexpr double kLeastExchange = 0.2;
/// Share of the gain of a law that another bend of it is worth at most.
constexpr double kOtherBend = 0.06;
/// Share of what is explained that is within the errors of its laws: alone, and beside a law that
/// is refuted.
constexpr double kLeastShare = 0.001, kLeastShareBesideRefuted = 0.003;
/// Share of what is explained that a remainder makes at least to be alarming: where it is plain, of
/// so much chi-square, and where it is not.
constexpr double kPlainRemainder = 0.002, kPlainChiSquare = 2000.0, kRemainder = 0.004;
/// Share of what was missing that counts as nothing.
constexpr double kNothing = 0.05;
/// Share of what is left, in its lowest band, that makes it slow.
constexpr double kMostlySlow = 0.7;
/// Share of the gain of refuted laws that a simpler set keeps at least.
constexpr double kKeptOfRefuted = 0.2;
/// Share of a law's or an effect's gain that must remain where all are fitted together, or on other
/// data: even odds.
constexpr double kRemains = 0.5;
/// Factor either way to within which a shape is known that is called known.
constexpr double kKnownWithin = 10.0;
/// Turns of the position away at which a cable has no rest.
constexpr double kMostTurnsAway = 3.0;
/// Odds from which on the commoner of two names gives way.
constexpr double kLikelier = 2.0;
/// By how much the choice among many widens an interval.
constexpr double kSelection = 1.2;
/// Correlation from which on a strength hangs on a shape.
constexpr double kTied = 0.7;
/// Times its noise, up to which an error is called that of the noise.
constexpr double kMostOverNoise = 1.2;
/// Times its noise, from which on a channel varies.
constexpr double kVaries = 1.5;
/// Share of a held-out error below which a gain is none.
constexpr double kLeastHeldOutGain = 0.005;
/// Gain in prices of a number beyond which nothing is a coincidence, however few moves there are.
constexpr double kCertainGain = 50.0;
/// Times what is left, that an event must explain to be kept where a search begins again.
constexpr double kPlainEvent = 20.0;
/// What a force that acts for some time lasts at most [s], and as a share of its recording; from
/// either end of a recording a step is an offset for so long [s].
constexpr double kLongestEvent = 60.0, kMostOfRecording = 0.6, kStepEnds = 2.5;
/// Deviations by which a band of what is left stands out, and windows that are shown.
constexpr double kBandStandsOut = 5.0, kOutstanding = 6.0;
/// Deviations of the noise of its position that an axis moves at least.
constexpr double kMoves = 10.0;
/// Share of a line of the force in the motion's own spectrum beyond which it is no hum.
constexpr double kMostlyMotion = 0.5;
/// Gain in chi-square of the best of some 10,000 frequencies, beyond the price of its numbers.
constexpr double kLeastLine = 28.0;
/// Of impacts between stops, in deviations of the same sum at other times: in all, without the
/// loudest one, and over the greatest of those.
constexpr double kImpacts = 6.0, kImpactsWithoutOne = 2.5, kImpactsOverOthers = 1.5;
/// Deviations, and times its degrees of freedom, at which a score of constancy refutes a law.
constexpr double kInconstant = 9.0, kInconstantRatio = 2.5;
/// Gain of chi-square from which on a modulation refutes a law: noise makes 18 in one of a thousand
/// (the largest of some 24 with a degree of freedom each), a second law too faint for a name 20.
constexpr double kModulated = 25.0;
/// The same of a second mode, whose frequency and damping are searched for.
constexpr double kSecondMode = 40.0;
/// The same of a term of pose, rates, force or time in what is called noise.
constexpr double kDependence = 40.0;
/// Gain of the log-likelihood before noise is called coloured: in its band, and in that band's
/// upper part.
constexpr double kColour = 12.0, kColourAbove = 3.0;
/// The same for one number of slow noise more.
constexpr double kSlowNoiseNumber = 3.0;
/// Least price of a number beside slow noise, whose next sample has another slope.
constexpr double kPriceInSlowNoise = 20.0;
/// Factor by which a deviation of the noise falls before all is weighed again.
constexpr double kFloorMoved = 1.5;

}  // namespace dcnn::evidence::prior

namespace dcnn {
namespace prior = evidence::prior;
}
