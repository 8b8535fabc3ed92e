from fcm.continuation.front cimport Front, Place
