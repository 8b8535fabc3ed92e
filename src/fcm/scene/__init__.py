"""Reads scenes from TOML and checks them: the structure, its contacts and forces, and what to trace."""

import sys

from fcm.model import interface as model_interface
from fcm.model import ring as model_ring
from fcm.model import scene as model_scene
from fcm.model.scene import Contact, Force, Modal, Phase, Scene, Start
from fcm.scene.errors import SceneError
from fcm.scene.load import bundled_scenes, load_scene, scene_from_dict

__all__ = [
    "Contact",
    "Force",
    "Modal",
    "Phase",
    "Scene",
    "SceneError",
    "Start",
    "bundled_scenes",
    "load_scene",
    "scene_from_dict",
]

# earlier names of these modules
sys.modules.update(
    {"fcm.scene.model": model_scene, "fcm.scene.ring": model_ring, "fcm.scene.interface": model_interface}
)
