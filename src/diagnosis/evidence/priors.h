// Every prior of the diagnosis, in one table (docs/develop/priors.md says where each comes from).
#pragma once

namespace dcnn::evidence::prior {

constexpr double kName = 0.04;  ///< probability of each listed effect, shared by its axes
/// Of a law that bends a commoner one, as a share of the latter's; in a search it costs one number
/// more. Also of one number in the place of several.
constexpr double kSpecial = 0.1;
constexpr double kUsualDelay = 0.1;  ///< mean of a delay's size [s]; exponential
/// On a machine, of a law that nearly every one has (dry and viscous friction): even odds, for what
/// resists may be small, or in its simulator.
constexpr double kCommon = 0.5;
constexpr double kUnknown = 0.12;   ///< of physics that no effect of the catalogue describes
constexpr double kSlowNoise = 0.1;  ///< of noise that grows below the floor's band
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

}  // namespace dcnn::evidence::prior
