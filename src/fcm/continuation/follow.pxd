from fcm.continuation.events cimport Landing
from fcm.continuation.recorder cimport NonsmoothPoints, Recorder
from fcm.continuation.options cimport FollowOptions, StepOptions, SwitchingOptions
from fcm.continuation.problem cimport Point, PointStore, Problem
from fcm.continuation.step_control cimport Stepper
