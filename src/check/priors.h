// Every number of the check that is neither a probability with a distribution, a physical bound nor
// a numerical tolerance.
#pragma once

namespace dcnn::check {

/// Probability of each kind of fault in somebody's log, shared by its variants.
constexpr double kFaultPrior = 0.004;
/// Independent residuals at most: what physics beyond the rigid tool leaves is alike for seconds.
constexpr double kMostIndependent = 40.0;
/// Share of the force's deviation that a rigid tool may be wrong by.
constexpr double kToolError = 0.01;
/// Probability that forces show no inertia: of a simulator without it, or filtered.
constexpr double kQuasiStatic = 0.1;
/// No plausibility of one quantity counts more than this [nats].
constexpr double kMostSurprise = 30.0;

/// Relative error of a link's described mass, moment and inertia.
constexpr double kLinkError = 0.3;
/// Share of a joint's torque that a described arm may be wrong by.
constexpr double kArmError = 0.05;
/// Independent residuals of a joint in a second: what a description leaves is as slow as the
/// motion.
constexpr double kIndependentPerSecond = 1.0;
/// Mass of what an arm carries, over its own.
constexpr double kPayloadShare = 0.1;

/// Log-normal quantities of people's logs: median, and deviation of the logarithm below and above.
struct Typical {
  double median, below, above;
};
constexpr Typical kRate{250.0, 1.1, 1.1};       ///< sampling rate [Hz]
constexpr Typical kSlowRate{0.5, 1.2, 1.2};     ///< of readings taken one by one [Hz]
constexpr double kSlowShare = 0.05;             ///< of such logs
constexpr Typical kLogDuration{60.0, 1.6, 1.6};    ///< of a recording [s]
constexpr Typical kTurnSpeed{0.4, 3.0, 1.4};    ///< rms angular speed [rad/s]; slow is no surprise
constexpr Typical kSpeed{0.15, 3.0, 1.4};       ///< rms speed of the sensor [m/s]
constexpr Typical kReach{0.15, 3.0, 1.0};       ///< rms distance from the mean position [m]
constexpr Typical kDistance{0.8, 2.0, 0.8};     ///< mean distance from the robot's base [m]
constexpr Typical kTurn{0.6, 3.0, 0.9};         ///< rms deviation of an angle [rad]
constexpr Typical kMass{1.0, 1.3, 1.3};         ///< of a tool nobody described [kg]
constexpr double kNominalMassSpread = 0.35;     ///< of the logarithm of mass over sim.json's
constexpr Typical kLever{0.08, 1.0, 1.0};       ///< torque over force, gravity on a tool [m]
constexpr Typical kOrderedRows{0.7, 1.0, 1.0};  ///< von Neumann's ratio of poses somebody chose
constexpr double kCountsRange = 50.0;           ///< whole units that a physical channel ranges over

}  // namespace dcnn::check
