from fcm.continuation.front cimport Front
from fcm.continuation.place cimport Place
from fcm.continuation.problem cimport Problem
from fcm.continuation.trail cimport Trail
