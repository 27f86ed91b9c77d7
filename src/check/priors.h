// SPDX-License-Identifier: Apache-2.0
// Every number of the check that is neither a probability with a distribution, a physical bound nor
// a numerical tolerance.
#pragma once

namespace dcnn::check {

constexpr double kEarthGravity = 9.81;  ///< m/s^2; it varies by 0.5 % over the Earth

/// Probability of each kind of fault in somebody's log, shared by its variants.
constexpr double kFaultPrior = 0.004;
/// Probability that a joint's measured column is what its drive was told, a constant for a while.
constexpr double kCommanded = 0.05;
/// Probability that a joint's rate is logged of another shaft, through a gear.
constexpr double kOtherShaft = 0.001;
/// Decades that the factor of an unknown unit of a rate may lie in, each place of them as probable.
constexpr double kRateDecades = 4.0;
/// Probability that a sensor's reading has at most two significant digits: of four that are written
/// 90 of 9000.
constexpr double kTwoDigits = 0.01;
/// Probability that a sensor was zeroed in some pose before the recording.
constexpr double kZeroedBefore = 0.01;
/// Independent residuals at most: what physics beyond the rigid tool leaves is alike for seconds.
constexpr double kMostIndependent = 40.0;
/// The same where their correlation from row to row is measured: it does not show what comes slower
/// than the log is long.
constexpr double kMostIndependentRows = 200.0;
/// Share of the force's deviation that a rigid tool may be wrong by.
constexpr double kToolError = 0.01;
/// Probability that forces show no inertia: of a simulator without it, or filtered.
constexpr double kQuasiStatic = 0.1;
/// Share of a quantity's power that a model leaves at most, where its readings are told apart.
constexpr double kMostForeign = 0.5;
/// No plausibility of one quantity counts more than this [nats].
constexpr double kMostSurprise = 30.0;

/// Probability that what a channel's model leaves looks like a shift in time of its own: of a
/// joint, whose friction and elasticity nobody describes, and of an axis of a wrist's force.
constexpr double kJointShift = 0.5, kAxisShift = 0.02;
/// Spikes of a single row over those of two rows, and over those of three.
constexpr double kWiderRarer = 3.0;

/// Relative error of a link's described mass, moment and inertia.
constexpr double kLinkError = 0.3;
/// Share of a joint's torque that a described arm may be wrong by.
constexpr double kArmError = 0.05;
/// Independent residuals in a second: what a description of the rigid bodies leaves is as slow as
/// the motion, which has a band of some 1 Hz.
constexpr double kIndependentPerSecond = 2.0;
/// Mass of what an arm carries, over its own.
constexpr double kPayloadShare = 0.1;

/// Rows below which neighbours may be alike by chance.
constexpr int kFewRows = 50;
/// Deviations below which the motion is said to show a number: of a mass, over it; of a centre of
/// mass [m]; of an offset, over the weight of the tool or of kLightTool [kg], the lighter one of
/// which no force sensor tells; of a drive's friction and inertia, over the joint's rms torque.
constexpr double kMassTold = 0.1, kCentreTold = 0.01, kOffsetTold = 0.02, kLightTool = 0.1;
constexpr double kDriveTold = 0.1;

/// Log-normal quantities of people's logs: median, and deviation of the logarithm below and above.
struct Typical {
  double median, below, above;
};
constexpr Typical kRate{250.0, 1.1, 1.1};        ///< sampling rate [Hz]
constexpr Typical kSlowRate{0.5, 1.2, 1.2};      ///< of readings taken one by one [Hz]
constexpr double kSlowShare = 0.05;              ///< of such logs
constexpr Typical kLogDuration{60.0, 1.6, 1.6};  ///< of a recording [s]
constexpr Typical kTurnSpeed{0.4, 3.0, 1.4};     ///< rms angular speed [rad/s]; slow is no surprise
constexpr Typical kSpeed{0.15, 3.0, 1.4};        ///< rms speed of the sensor [m/s]
constexpr Typical kReach{0.15, 3.0, 1.0};        ///< rms distance from the mean position [m]
constexpr Typical kDistance{0.8, 2.0, 0.8};      ///< mean distance from the robot's base [m]
constexpr Typical kTurn{0.6, 3.0, 0.9};          ///< rms deviation of an angle [rad]
constexpr Typical kDriveTurn{30.0, 3.0, 2.0};    ///< the same of a motor or a wheel [rad]
constexpr double kDrives = 0.3;          ///< of logs of joints: they turn as often as they like
constexpr double kSlowTorque = 0.1;      ///< of joints: another dependence on the angle than weight
constexpr Typical kMass{1.0, 1.3, 1.3};  ///< of a tool nobody described [kg]
constexpr double kNominalMassSpread = 0.35;  ///< of the logarithm of mass over sim.json's
constexpr Typical kSubtracted{1.0, 0.5,
                              0.5};  ///< mass that a controller subtracts, over the tool's
constexpr double kPartly = 0.2;  ///< of logs with a subtracted weight: another mass than the tool's
constexpr Typical kOffset{3.0, 1.3, 1.3};    ///< of a sensor [N]
constexpr Typical kLever{0.08, 1.0, 1.0};    ///< torque over force, gravity on a tool [m]
constexpr double kNominalLeverSpread = 0.5;  ///< of c about sim.json's, over its length
/// Probability that the lever is nothing like sim.json's: of another tool, or a force from which a
/// controller takes the weight off beside a torque from which it does not.
constexpr double kOtherLever = 0.01;
/// Von Neumann's ratio of a channel: of a motion; of poses in an order that somebody chose, where
/// that channel goes from one end to the other, and where it does not.
constexpr Typical kMovingRows{0.03, 2.0, 2.0}, kOrderedSlow{0.05, 1.5, 1.5},
    kOrderedRows{1.5, 0.5, 0.5};
constexpr double kSlowChannels = 0.2;
constexpr double kCountsRange = 50.0;  ///< whole units that a physical channel ranges over

}  // namespace dcnn::check
