//! Geoms of a world: shapes on bodies, or fixed in the world.

use crate::{Error, Material, World};
use ferrode_collide::{ColliderError, Geom, GeomKey, Shape, SpaceKey};
use ferrode_dynamics::BodyKey;
use ferrode_math::Pose;

/// What a world knows of a geom beyond its shape and place.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct GeomInfo {
    /// The geom.
    pub key: GeomKey,
    /// The body that it moves with; `None` for a part of the static world.
    pub body: Option<BodyKey>,
    /// Its surface.
    pub material: Material,
    /// A number of the caller's.
    pub user_data: u64,
    /// The pose version of the body that the geom was last moved to.
    pub(crate) seen_pose: Option<u64>,
    /// Changed by hand since `Substep` last looked.
    pub(crate) changed: bool,
}

impl World {
    /// Adds a geom to the static world at a pose.
    ///
    /// # Errors
    /// [`Error::Collider`] if the pose is not finite.
    pub fn add_static(&mut self, shape: impl Into<Shape>, pose: Pose) -> Result<GeomKey, Error> {
        if !pose.is_finite() {
            return Err(ColliderError::BadPose(pose).into());
        }
        self.insert_geom(Geom::new(shape).at(pose), None)
    }

    /// Adds a geom to a body, at a pose in the body's frame. The body's mass stays as it is.
    ///
    /// # Errors
    /// [`Error::Dynamics`] for a key that names no body, [`Error::Collider`] for a pose that is not finite or a shape
    /// that can't be placed (a plane).
    pub fn add_geom(
        &mut self,
        body: BodyKey,
        shape: impl Into<Shape>,
        offset: Pose,
    ) -> Result<GeomKey, Error> {
        if !offset.is_finite() {
            return Err(ColliderError::BadPose(offset).into());
        }
        let pose = self.dynamics.body(body)?.pose();
        let shape = shape.into();
        let placeable = shape.is_placeable();
        let offset = (offset != Pose::IDENTITY).then_some(offset);
        let geom = Geom::new(shape).at(pose * offset.unwrap_or_default()).on_body(body.serial(), offset);
        let key = self.insert_geom(geom, Some(body))?;
        if !placeable {
            self.remove_geom(key)?;
            return Err(ColliderError::NotPlaceable(key).into());
        }
        // Mostly there is one.
        self.geoms_of_body.entry(body).or_insert_with(|| Vec::with_capacity(1)).insert(0, key);
        Ok(key)
    }

    fn insert_geom(&mut self, geom: Geom, body: Option<BodyKey>) -> Result<GeomKey, Error> {
        let slot = self.free_geom_slots.pop().unwrap_or(self.geom_infos.len());
        let key = self.colliders.add_geom(Some(self.space), geom.with_user(slot as u64))?;
        let info = GeomInfo {
            key,
            body,
            material: self.default_material,
            user_data: 0,
            seen_pose: None,
            changed: true,
        };
        self.geom_version += 1;
        match self.geom_infos.get_mut(slot) {
            Some(place) => *place = Some(info),
            None => self.geom_infos.push(Some(info)),
        }
        Ok(key)
    }

    /// Removes a geom.
    ///
    /// # Errors
    /// [`Error::Collider`] for a key that names no geom.
    pub fn remove_geom(&mut self, geom: GeomKey) -> Result<(), Error> {
        let slot = self.geom_slot(geom)?;
        self.wake_touching(slot);
        self.geom_version += 1;
        self.colliders.remove_geom(geom);
        if let Some(info) = self.geom_infos[slot].take()
            && let Some(body) = info.body
            && let Some(geoms) = self.geoms_of_body.get_mut(&body)
        {
            geoms.retain(|key| *key != geom);
        }
        self.free_geom_slots.push(slot);
        self.touching.retain(|(a, b)| *a != slot && *b != slot);
        Ok(())
    }

    /// Body, surface and user data of a geom.
    ///
    /// # Errors
    /// [`Error::Collider`] for a key that names no geom.
    pub fn geom_info(&self, geom: GeomKey) -> Result<&GeomInfo, Error> {
        let slot = self.geom_slot(geom)?;
        self.geom_infos[slot].as_ref().ok_or(ColliderError::NoSuchGeom(geom).into())
    }

    /// Shape and place of a geom. A geom on a body is where the body was at the last step or
    /// [`World::sync_geoms`].
    ///
    /// # Errors
    /// [`Error::Collider`] for a key that names no geom.
    pub fn geom(&self, geom: GeomKey) -> Result<&Geom, Error> {
        self.colliders.geom(geom).ok_or(ColliderError::NoSuchGeom(geom).into())
    }

    /// All geoms.
    pub fn geoms(&self) -> impl Iterator<Item = &GeomInfo> + '_ {
        self.geom_infos.iter().flatten()
    }

    /// Number of geoms.
    pub fn geom_count(&self) -> usize {
        self.geom_infos.len() - self.free_geom_slots.len()
    }

    /// The geoms of a body, the newest first.
    ///
    /// # Errors
    /// [`Error::Dynamics`] for a key that names no body.
    pub fn body_geoms(&self, body: BodyKey) -> Result<&[GeomKey], Error> {
        self.dynamics.body(body)?;
        Ok(self.geoms_of_body.get(&body).map_or(&[], Vec::as_slice))
    }

    /// The surface that new geoms get.
    pub fn default_material(&self) -> &Material {
        &self.default_material
    }

    /// Sets the surface that new geoms get.
    ///
    /// # Errors
    /// [`Error::Dynamics`] naming the first unusable number.
    pub fn set_default_material(&mut self, material: Material) -> Result<(), Error> {
        material.check()?;
        self.default_material = material;
        Ok(())
    }

    /// Sets a geom's surface.
    ///
    /// # Errors
    /// [`Error::Collider`] for a key that names no geom, [`Error::Dynamics`] naming the first unusable number.
    pub fn set_material(&mut self, geom: GeomKey, material: Material) -> Result<(), Error> {
        material.check()?;
        let info = self.geom_info_mut(geom)?;
        info.material = material;
        info.changed = true;
        self.rules_version += 1;
        self.geom_version += 1;
        Ok(())
    }

    /// Sets the caller's number of a geom.
    ///
    /// # Errors
    /// [`Error::Collider`] for a key that names no geom.
    pub fn set_geom_user_data(&mut self, geom: GeomKey, data: u64) -> Result<(), Error> {
        self.geom_info_mut(geom)?.user_data = data;
        Ok(())
    }

    /// Sets what a geom is (`category`) and what it collides with (`collide`): two geoms may collide if the category of
    /// one meets the collide bits of the other, either way round.
    ///
    /// # Errors
    /// [`Error::Collider`] for a key that names no geom.
    pub fn set_geom_bits(&mut self, geom: GeomKey, category: u64, collide: u64) -> Result<(), Error> {
        self.colliders.set_bits(geom, category, collide)?;
        self.note_geom(geom)
    }

    /// Switches a geom on or off.
    ///
    /// # Errors
    /// [`Error::Collider`] for a key that names no geom.
    pub fn set_geom_enabled(&mut self, geom: GeomKey, enabled: bool) -> Result<(), Error> {
        self.colliders.set_enabled(geom, enabled)?;
        self.note_geom(geom)
    }

    /// Moves a geom: a static one to a world pose, one of a body to a pose in the body's frame.
    ///
    /// # Errors
    /// [`Error::Collider`] for a key that names no geom, a pose that is not finite, or a plane.
    pub fn set_geom_pose(&mut self, geom: GeomKey, pose: Pose) -> Result<(), Error> {
        if !pose.is_finite() {
            return Err(ColliderError::BadPose(pose).into());
        }
        let info = self.geom_info_mut(geom)?;
        info.seen_pose = None;
        match info.body {
            None => self.colliders.set_pose(geom, pose)?,
            Some(_) => self.colliders.set_offset(geom, Some(pose))?,
        }
        self.note_geom(geom)
    }

    /// Has `Substep` look at a geom anew that was changed by hand, and wakes what rests on it.
    fn note_geom(&mut self, geom: GeomKey) -> Result<(), Error> {
        self.geom_version += 1;
        let slot = self.geom_slot(geom)?;
        self.geom_info_mut(geom)?.changed = true;
        self.wake_touching(slot);
        Ok(())
    }

    /// The space that all geoms of this world are in.
    pub fn space(&self) -> SpaceKey {
        self.space
    }

    /// Moves the geoms of all bodies to where the bodies are. [`World::step`] does it by itself; call it before asking
    /// for contacts by hand.
    pub fn sync_geoms(&mut self) {
        for info in self.geom_infos.iter_mut().flatten() {
            let Some(body) = info.body else { continue };
            let Ok(body) = self.dynamics.body(body) else { continue };
            if info.seen_pose != Some(body.pose_version())
                && self.colliders.set_body_pose(info.key, &body.pose()).is_ok()
            {
                info.seen_pose = Some(body.pose_version());
            }
        }
    }

    pub(crate) fn geom_slot(&self, geom: GeomKey) -> Result<usize, Error> {
        let missing = || Error::from(ColliderError::NoSuchGeom(geom));
        Ok(self.colliders.geom(geom).ok_or_else(missing)?.user() as usize)
    }

    fn geom_info_mut(&mut self, geom: GeomKey) -> Result<&mut GeomInfo, Error> {
        let slot = self.geom_slot(geom)?;
        let missing = || Error::from(ColliderError::NoSuchGeom(geom));
        self.geom_infos.get_mut(slot).and_then(Option::as_mut).ok_or_else(missing)
    }
}
