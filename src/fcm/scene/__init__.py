"""A scene: the structure, its contacts and forces, what to trace; from TOML, and checked."""

from fcm.scene.errors import SceneError
from fcm.scene.load import bundled_scenes, load_scene, scene_from_dict
from fcm.scene.model import Contact, Force, Modal, Phase, Scene, Start

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
