from fcm.continuation.events cimport Landing
from fcm.continuation.nonsmooth_points cimport NonsmoothPoints
from fcm.continuation.options cimport FollowOptions, StepOptions, SwitchingOptions
from fcm.continuation.point cimport Point
from fcm.continuation.point cimport PointStore
from fcm.continuation.problem cimport Problem
from fcm.continuation.recorder cimport Recorder
from fcm.continuation.stepper cimport Stepper
