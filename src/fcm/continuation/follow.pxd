from fcm.continuation.front cimport Front, Place
from fcm.continuation.problem cimport Problem
