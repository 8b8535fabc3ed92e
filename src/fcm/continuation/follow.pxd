from fcm.continuation.front cimport Front, Place
from fcm.continuation.problem cimport Problem
from fcm.continuation.trail cimport Trail
