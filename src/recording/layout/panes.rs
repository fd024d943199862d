//! Views, the containers around them, and their properties. Rerun's own builder of layouts has no
//! setter for most properties, and it has random names.

use rerun::external::re_sdk_types::blueprint::archetypes::{
    ContainerBlueprint, PanelBlueprint, TimePanelBlueprint, ViewBlueprint, ViewContents,
    ViewportBlueprint,
};
use rerun::external::re_sdk_types::blueprint::components::{ContainerKind, PanelState};
use rerun::external::re_sdk_types::{View, datatypes};
use rerun::{AsComponents, EntityPath, TimeColumn};

use crate::recording::Logged;
use crate::recording::recorder::Recorder;

/// The timeline of a layout: changes by the user come later on it.
const TIMELINE: &str = "blueprint";

#[derive(Debug)]
pub struct Pane {
    /// Its entity in the layout.
    path: String,
    id: [u8; 16],
}

#[derive(Debug, Default)]
pub struct Panes {
    rec: Recorder,
    panes: u64,
}

impl Panes {
    /// Adds a view of a class, with its name and the entity at its origin.
    pub fn view<V: View>(&mut self, name: &str, origin: &str) -> Logged<Pane> {
        let pane = self.pane("view");
        let contents = ViewContents::new(["$origin/**"]);
        self.log(&format!("{}/ViewContents", pane.path), &contents)?;
        let view = ViewBlueprint::new(V::identifier().as_str())
            .with_display_name(name)
            .with_space_origin(format!("/{origin}"));
        self.log(&pane.path, &view)?;
        Ok(pane)
    }

    pub fn set(&mut self, pane: &Pane, property: &str, value: &dyn AsComponents) -> Logged {
        self.log(&format!("{}/{property}", pane.path), value)
    }

    /// Sets how a view shows an entity and all below it.
    pub fn set_of(&mut self, pane: &Pane, entity: &EntityPath, value: &dyn AsComponents) -> Logged {
        let entity = entity.to_string();
        let entity = entity.trim_start_matches('/');
        let property = format!("ViewContents/overrides/{entity}/visualizers");
        self.set(pane, &property, value)
    }

    /// Puts panes beside one another, each with its fraction of the width.
    pub fn beside(
        &mut self,
        panes: &[Pane],
        shares: impl IntoIterator<Item = f32>,
    ) -> Logged<Pane> {
        let kind = ContainerBlueprint::new(ContainerKind::Horizontal);
        self.container(panes, kind.with_col_shares(shares))
    }

    /// Puts panes one below another, each with its fraction of the height.
    pub fn below(&mut self, panes: &[Pane], shares: impl IntoIterator<Item = f32>) -> Logged<Pane> {
        let kind = ContainerBlueprint::new(ContainerKind::Vertical);
        self.container(panes, kind.with_row_shares(shares))
    }

    /// Puts panes behind one another, the first in front.
    pub fn tabs(&mut self, panes: &[Pane]) -> Logged<Pane> {
        let tabs = ContainerBlueprint::new(ContainerKind::Tabs);
        self.container(panes, tabs)
    }

    pub fn grid(&mut self, panes: &[Pane], columns: u32) -> Logged<Pane> {
        let kind = ContainerBlueprint::new(ContainerKind::Grid);
        self.container(panes, kind.with_grid_columns(columns))
    }

    /// Finishes the layout: `root` fills the window above the time panel, other panels are hidden.
    pub fn finished(mut self, root: &Pane, time: &TimePanelBlueprint) -> Logged<Recorder> {
        let viewport = ViewportBlueprint::new()
            .with_root_container(datatypes::Uuid::from(root.id))
            .with_auto_layout(false)
            .with_auto_views(false);
        self.log("viewport", &viewport)?;
        let hidden = PanelBlueprint::new().with_state(PanelState::Hidden);
        self.log("blueprint_panel", &hidden)?;
        self.log("selection_panel", &hidden)?;
        self.log("time_panel", time)?;
        Ok(self.rec)
    }

    fn container(&mut self, panes: &[Pane], container: ContainerBlueprint) -> Logged<Pane> {
        let pane = self.pane("container");
        let contents = panes.iter().map(|p| format!("/{}", p.path));
        self.log(&pane.path, &container.with_contents(contents))?;
        Ok(pane)
    }

    /// Adds a pane, named by its number in the form of a UUID.
    fn pane(&mut self, kind: &str) -> Pane {
        self.panes += 1;
        let id = (0x4000_8000_u128 << 64) | u128::from(self.panes);
        let hex = format!("{id:032x}");
        let parts = [
            &hex[..8],
            &hex[8..12],
            &hex[12..16],
            &hex[16..20],
            &hex[20..],
        ];
        Pane {
            path: format!("{kind}/{}", parts.join("-")),
            id: id.to_be_bytes(),
        }
    }

    fn log(&mut self, entity: &str, parts: &dyn AsComponents) -> Logged {
        let time = TimeColumn::new_sequence(TIMELINE, [0]);
        let columns = parts.as_serialized_batches().into_iter();
        self.rec
            .send_columns(entity, Some(time), columns.map(Into::into))
    }
}
