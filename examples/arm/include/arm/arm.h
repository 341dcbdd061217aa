// The arm that both control nodes talk about.
#ifndef ARM_ARM_H
#define ARM_ARM_H

namespace arm
{

constexpr int    kJoints                 = 7;
constexpr double kInertia[kJoints]       = {4.0, 4.0, 2.0, 1.5, 0.6, 0.5, 0.2};  // kg m^2, seen at the joint
constexpr double kFriction[kJoints]      = {8.0, 8.0, 5.0, 4.0, 2.0, 1.5, 0.8};  // N m s/rad
constexpr double kTorquePerAmp[kJoints]  = {2.0, 2.0, 1.5, 1.5, 0.8, 0.8, 0.4};  // N m/A
constexpr double kStowed[kJoints]        = {0.0, -1.2, 0.0, 2.2, 0.0, -1.0, 0.0};  // rad
constexpr double kContact[kJoints]       = {0.6, 0.1, 0.3, 0.9, -0.4, 0.6, 1.2};   // rad: fingers around the debris
constexpr double kCurrentLimit           = 5.0;                                    // A

}  // namespace arm

#endif
